"""The picture shows an object as large as it is, beside a hand."""

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from inhand_lab.new_objects.drawn_hand import HAND_LENGTH, open_hand
from inhand_lab.new_objects.picture import CLAY, WIDTH, draw_object, write_picture
from inhand_lab.objects.handled_shapes import build_box
from inhand_lab.world.messages import shape_of
from inhand_runtime.errors import InhandError

BOX = shape_of(build_box("box", 0.20, 0.12, 0.05))


def heights(picture: np.ndarray, wide: int) -> tuple[int, int]:
    """Rows in which object and hand are so many pixels wide, in the view from the side."""
    view = picture[:, WIDTH:].astype(int)
    red, blue = view[:, :, 0], view[:, :, 2]
    object_rows = np.flatnonzero(((blue - red) > 25).sum(axis=1) > wide)
    hand_rows = np.flatnonzero(((red - blue) > 15).sum(axis=1) > wide)
    return int(np.ptp(object_rows)), int(np.ptp(hand_rows))


@pytest.mark.long  # compiles what draws
def test_hand_and_object_have_the_ratio_of_their_true_sizes() -> None:
    assert CLAY[2] > CLAY[0]
    hand = np.ptp(open_hand().vertices[:, 2])
    rows, hand_rows = heights(draw_object(BOX), wide=20)
    assert rows / hand_rows == pytest.approx(0.20 / hand, rel=0.06)


@pytest.mark.long
def test_a_mesh_whose_triangles_face_inwards_is_drawn_alike() -> None:
    turned = replace(BOX, faces=BOX.faces[:, ::-1])
    assert np.abs(draw_object(turned).astype(int) - draw_object(BOX)).mean() < 0.5


@pytest.mark.parametrize("size", [0.005, 4.0])
@pytest.mark.long
def test_the_smallest_and_the_largest_object_are_shown(size: float, tmp_path: Path) -> None:
    scaled = replace(
        BOX, vertices=BOX.vertices * size / 0.2, marked_vertices=BOX.marked_vertices * size / 0.2
    )
    write_picture(draw_object(scaled), tmp_path / "new/a.png")
    picture = cv2.imread(str(tmp_path / "new/a.png"))
    assert picture is not None
    assert heights(picture[:, :, ::-1], wide=3)[0] > 5


def test_a_hand_is_as_long_as_hands_are() -> None:
    assert open_hand().vertices[:, 2].max() == pytest.approx(HAND_LENGTH, abs=0.01)


def test_a_name_that_is_no_pictures_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InhandError, match=r"let it end in \.png or \.jpg"):
        write_picture(np.zeros((4, 4, 3), np.uint8), tmp_path / "a.txt")
