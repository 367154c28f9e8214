"""Nothing of what a mask covers leaves a source."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from inhand_capture.faces.discs import Disc
from inhand_capture.faces.finder import FacesFound
from inhand_capture.view.viewed_source import FacelessPixels, viewed
from inhand_runtime.pixels import encode_colour, encode_depth
from inhand_runtime.source import Captured, Pixels
from inhand_schemas.messages import CameraInfo, ColourImage, DepthImage, Person
from msgspec.structs import replace
from scripted_source import PERSON

WIDTH, HEIGHT = 64, 48
INFO = CameraInfo(sequence=0, time_ns=0, width=WIDTH, height=HEIGHT, fx=50, fy=50, cx=32, cy=24)
SECRET = 201
LEFT_HALF = ((0.0, 0.0), (0.5, 0.0), (0.5, 1.0), (0.0, 1.0))
"""Of the picture as published."""


class Still:
    """A source of one moment."""

    info = INFO

    def __init__(self, pixels: Pixels, person: Person = PERSON) -> None:
        self.pixels = pixels
        self.person = person

    def captures(self, _wanted: Callable[[], bool]) -> Iterator[Captured | None]:
        yield Captured(1, 0, lambda: self.pixels, (self.person,))
        yield None

    def close(self) -> None:
        """Nothing is open."""


def _secret_in(columns: slice, rows: slice) -> Pixels:
    colour, depth = np.full((HEIGHT, WIDTH, 3), 30, np.uint8), np.full((24, 32), 900, np.uint16)
    colour[rows, columns] = SECRET
    depth[slice(rows.start // 2, rows.stop // 2), slice(columns.start // 2, columns.stop // 2)] = (
        SECRET
    )
    return Pixels(colour, depth)


# Where the left half of the turned picture lies in the source's.
HALVES = {
    0: (slice(0, 32), slice(0, 48)),
    90: (slice(0, 64), slice(24, 48)),
    180: (slice(32, 64), slice(0, 48)),
    270: (slice(0, 64), slice(0, 24)),
}


def _encoded(pixels: Pixels) -> Pixels:
    assert isinstance(pixels.colour, np.ndarray)
    assert isinstance(pixels.depth, np.ndarray)
    return Pixels(encode_colour(pixels.colour), encode_depth(pixels.depth))


@pytest.mark.parametrize("degrees", HALVES)
@pytest.mark.parametrize("encode", [lambda pixels: pixels, _encoded], ids=["raw", "encoded"])
def test_no_masked_pixel_leaves_in_colour_or_depth(
    degrees: int, encode: Callable[[Pixels], Pixels]
) -> None:
    secret = _secret_in(*HALVES[degrees])
    source = viewed(Still(encode(secret)), degrees, [LEFT_HALF])
    captured = next(iter(source.captures(lambda: True)))
    assert captured is not None
    assert captured.pixels is not None
    seen = captured.pixels()
    assert isinstance(seen.colour, np.ndarray)
    assert isinstance(seen.depth, np.ndarray)
    for picture in (seen.colour, seen.depth):
        middle = picture.shape[1] // 2
        assert not picture[:, :middle].any()
        assert picture[:, -1].all()
    assert seen.colour.max() < 60, "a trace of the secret's brightness"
    assert SECRET not in seen.depth


def test_the_sources_own_pixels_stay_as_they_are() -> None:
    secret = _secret_in(*HALVES[0])
    assert isinstance(secret.colour, np.ndarray)
    before = secret.colour.copy()
    captured = next(iter(viewed(Still(secret), 0, [LEFT_HALF]).captures(lambda: True)))
    assert captured is not None
    assert captured.pixels is not None
    captured.pixels()
    np.testing.assert_array_equal(secret.colour, before)


def test_joints_in_a_mask_are_missing() -> None:
    behind, beside = (-0.5, 0.0, 2.0), (0.5, 0.0, 2.0)
    person = replace(PERSON, joints=(behind, beside) * 10)
    source = viewed(Still(_secret_in(*HALVES[0]), person), 0, [LEFT_HALF])
    captured = next(iter(source.captures(lambda: True)))
    assert captured is not None
    assert captured.people is not None
    (seen,) = captured.people
    assert seen.states == ("missing", "tracked") * 10
    assert seen.joints == ((0.0, 0.0, 0.0), beside) * 10


def test_a_picture_that_cannot_be_masked_is_left_out(caplog: pytest.LogCaptureFixture) -> None:
    damaged = Pixels(ColourImage("jpeg", 64, 48, b"no"), DepthImage("z16-zstd", 64, 48, b"no"))
    captured = next(iter(viewed(Still(damaged), 0, [LEFT_HALF]).captures(lambda: True)))
    assert captured is not None
    assert captured.pixels is not None
    assert captured.pixels() == captured.pixels() == Pixels(None, None)
    assert caplog.text.count("cannot be read, and so not be masked") == 1


def test_a_source_with_nothing_to_turn_or_to_mask_is_itself() -> None:
    still = Still(_encoded(_secret_in(*HALVES[0])))
    assert viewed(still, 0, []) is still


def test_a_turned_source_tells_how_the_turned_camera_sees() -> None:
    info = viewed(Still(_secret_in(*HALVES[0])), 90, []).info
    assert (info.width, info.height) == (HEIGHT, WIDTH)


class ToldFaces:
    """Finds the faces that it is told of, in the picture as everybody sees it."""

    def __init__(self, *discs: Disc) -> None:
        self.discs = discs
        self.looked = 0

    def find(self, colour: Any, _time_ns: int, skeletons: Any, _info: Any) -> FacesFound:
        self.looked += 1
        self.skeletons = skeletons
        return FacesFound(self.discs, colour.shape[:2], ())


LEFT_FACE = Disc(12.0, 20.0, 11.0)
"""Covers columns 4 to 20 and rows 12 to 28 of the picture as published."""
FACES = {
    0: (slice(4, 20), slice(12, 28)),
    180: (slice(44, 60), slice(20, 36)),
}


@pytest.mark.parametrize("degrees", FACES)
@pytest.mark.parametrize("encode", [lambda pixels: pixels, _encoded], ids=["raw", "encoded"])
def test_a_face_leaves_in_neither_colour_nor_depth_and_is_there_for_who_looks_inside(
    degrees: int, encode: Callable[[Pixels], Pixels]
) -> None:
    secret = _secret_in(*FACES[degrees])
    faces: Any = ToldFaces(LEFT_FACE)
    source = viewed(Still(encode(secret)), degrees, [], faces)
    captured = next(iter(source.captures(lambda: True)))
    assert captured is not None
    assert captured.pixels is not None
    seen = captured.pixels()
    assert isinstance(seen, FacelessPixels)
    assert isinstance(seen.colour, np.ndarray)
    assert isinstance(seen.depth, np.ndarray)
    assert seen.colour.max() < 60, "a trace of the face's brightness"
    assert SECRET not in seen.depth
    assert (seen.depth == 900).mean() > 0.7
    assert isinstance(seen.whole.colour, np.ndarray)
    assert isinstance(seen.whole.depth, np.ndarray)
    assert seen.whole.colour.max() > 180
    assert SECRET in seen.whole.depth


def test_every_picture_is_looked_at_once_while_any_is_wanted() -> None:
    faces: Any = ToldFaces()
    source = viewed(Still(_secret_in(*HALVES[0])), 0, [], faces)
    captured = next(iter(source.captures(lambda: True)))
    assert faces.looked == 1
    assert captured is not None
    assert captured.pixels is not None
    assert captured.pixels() is captured.pixels()
    assert faces.looked == 1
    next(iter(source.captures(lambda: False)))
    assert faces.looked == 1


def test_a_picture_without_colour_is_left_out_where_faces_are_hidden(
    caplog: pytest.LogCaptureFixture,
) -> None:
    faces: Any = ToldFaces()
    blind = Pixels(None, _secret_in(*HALVES[0]).depth)
    captured = next(iter(viewed(Still(blind), 0, [], faces).captures(lambda: True)))
    assert captured is not None
    assert captured.pixels is not None
    assert captured.pixels() == Pixels(None, None)
    assert faces.looked == 0
    assert "has no colour, in which faces could be found" in caplog.text


def test_skeletons_are_turned_for_who_looks_for_faces() -> None:
    faces: Any = ToldFaces()
    next(iter(viewed(Still(_secret_in(*HALVES[0])), 180, [], faces).captures(lambda: True)))
    assert faces.skeletons[0].joints[0] == (-0.1, -0.2, 2.0)
