"""Recordings without faces, or without people."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
import simplejpeg
from coded_rig import recoded
from inhand_capture.estimation.found_person import FoundPerson
from inhand_capture.faces.finder import FaceFinder
from inhand_recorder.attachments import read_attachments
from inhand_recorder.inspection import inspect_recording
from inhand_recorder.verification import examine_recording
from inhand_runtime.pixels import decode_colour, decode_depth
from inhand_runtime.recording import (
    RecordedMessage,
    RecordingError,
    RecordingWriter,
    read_recording,
)
from inhand_runtime.recording.copying import copy_message, write_beside
from inhand_schemas.joints import Joint
from inhand_schemas.messages import RgbdFrame
from inhand_schemas.topics import PREVIEW, RGBD, TOPICS
from msgspec.structs import replace
from numpy.typing import NDArray
from posed_person import ToldNetwork, pixels_of, seen, standing
from walked_past import MUG, MUG_MM, PERSON, ToldFaces, depth_at, person_at, told_finder, write_walk

from inhand.redaction.hiding import What
from inhand.redaction.redacted import WITHOUT_PICTURES, Redaction, redact_recording

PAST = [-0.6, -0.4, -0.2, 0.0, 0.2, 0.4, 0.6]
BLACK = 70
"""Brightest that JPEG makes a black pixel whose neighbours are not."""


def redact(path: Path, what: What, found: Sequence[float | None]) -> tuple[Redaction, Path]:
    output = path.with_name(f"{what}.mcap")
    return redact_recording([path], output, what, told_finder(found)), output


def frames_of(path: Path) -> list[tuple[NDArray[np.uint8], NDArray[np.uint16]]]:
    frames = (RGBD.decode(one.payload) for one in read_recording(path, streams=("rgbd",)))
    return [
        (decode_colour(one.colour), decode_depth(one.depth))
        for one in frames
        if one.colour is not None and one.depth is not None
    ]


def previews_of(path: Path) -> list[NDArray[np.uint8]]:
    previews = (PREVIEW.decode(one.payload) for one in read_recording(path, streams=("preview",)))
    return [simplejpeg.decode_jpeg(one.jpeg, "RGB") for one in previews]


def identity(message: RecordedMessage) -> tuple[object, ...]:
    pictures = message.topic in (RGBD, PREVIEW)
    stamp = message.received_ns, message.captured_ns, message.sequence
    return message.key, *stamp, None if pictures else message.payload


def head_at(x: float) -> NDArray[np.bool_]:
    """The upper half of a head: below are shoulders."""
    person = person_at(x).copy()
    person[round(pixels_of(standing(x))[3, 1]) :] = False
    return person


def test_no_pixel_of_a_person_is_left_and_all_else_is_as_it_was(tmp_path: Path) -> None:
    path = write_walk(tmp_path / "walk.mcap", PAST)
    done, output = redact(path, "people", PAST)
    assert done.counts == {"frames": 7, "previews": 7}
    for x, (colour, depth), preview in zip(
        PAST, frames_of(output), previews_of(output), strict=True
    ):
        assert not depth[person_at(x)].any()
        assert colour[person_at(x)].max() < BLACK
        assert preview[person_at(x)[::2, ::2]].max() < BLACK
        shown = depth > 0
        np.testing.assert_array_equal(depth[shown], depth_at(x)[shown])
        assert (depth[MUG] == MUG_MM).all()
        assert shown.mean() > 0.3
        assert colour.max() < PERSON - 50
    assert [identity(one) for one in read_recording(output)] == [
        identity(one) for one in read_recording(path)
    ]


def test_of_h264_no_picture_stays_that_shows_or_builds_on_a_person(tmp_path: Path) -> None:
    path = recoded(write_walk(tmp_path / "jpeg.mcap", PAST), tmp_path / "walk.mcap")
    done, output = redact(path, "people", PAST)
    assert done.counts == {"frames": 7, "previews": 7}
    assert examine_recording(output).problems == ()
    for x, (colour, _) in zip(PAST, frames_of(output), strict=True):
        assert colour[person_at(x)].max() < BLACK
        assert colour.max() < PERSON - 50


def test_faces_are_hidden_and_hands_are_not(tmp_path: Path) -> None:
    path = write_walk(tmp_path / "walk.mcap", PAST)
    _, output = redact(path, "faces", PAST)
    hand_rows = slice(round(pixels_of(standing(0.0))[7, 1]), None)
    for x, (colour, depth), preview in zip(
        PAST, frames_of(output), previews_of(output), strict=True
    ):
        head = head_at(x)
        assert head.sum() > 500
        assert not depth[head].any()
        assert colour[head].max() < BLACK
        assert preview[head[::2, ::2]].max() < BLACK
        np.testing.assert_array_equal(depth[hand_rows], depth_at(x)[hand_rows])


@pytest.mark.parametrize("what", ["faces", "people"])
def test_who_is_missed_in_a_frame_is_hidden_by_its_neighbours(tmp_path: Path, what: What) -> None:
    found = [None, None, -0.2, 0.0, None, None, 0.6]
    path = write_walk(tmp_path / "walk.mcap", PAST)
    _, output = redact(path, what, found)
    sought = person_at if what == "people" else head_at
    for x, (colour, depth) in zip(PAST, frames_of(output), strict=True):
        assert not depth[sought(x)].any()
        assert colour[sought(x)].max() < BLACK
        assert (depth[MUG] == MUG_MM).all()


@pytest.mark.parametrize("what", ["faces", "people"])
def test_a_frame_is_hidden_whole_where_somebody_may_be_and_nobody_was_found(
    tmp_path: Path, what: What
) -> None:
    there = [None, None, *[0.1] * 2, *[None] * 6, *PAST]
    found = [*[None] * 10, *PAST]
    path = write_walk(tmp_path / "walk.mcap", there)
    done, output = redact(path, what, found)
    assert done.counts["frames all hidden"] == 2
    shown, missed = frames_of(output)[:2], frames_of(output)[2:4]
    for colour, depth in missed:
        assert not colour.any()
        assert not depth.any()
    for colour, depth in shown:
        assert colour.all()
        np.testing.assert_array_equal(depth, depth_at(None))
    frames = [next(iter(read_recording(one, streams=("rgbd",)))) for one in (path, output)]
    assert frames[0].payload == frames[1].payload


@pytest.mark.parametrize("what", ["faces", "people"])
def test_all_frames_are_hidden_where_nobody_is_ever_found_or_nothing_tells_that_nobody_is_there(
    tmp_path: Path, what: What
) -> None:
    path = write_walk(tmp_path / "walk.mcap", [0.0, None])
    done, output = redact(path, what, [None])
    assert done.counts["frames all hidden"] == 2
    assert not any(picture.any() for picture in previews_of(output))
    flat = write_walk(tmp_path / "flat.mcap", [None] * 8 + [0.0], depth=False)
    done, _ = redact(flat, "people" if what == "faces" else "faces", [None] * 8 + [0.0])
    assert done.counts["frames all hidden"] == 3


@pytest.mark.parametrize("what", ["faces", "people"])
def test_somebody_else_who_is_never_found_is_hidden_while_they_move(
    tmp_path: Path, what: What
) -> None:
    found, others = [0.1 * place - 0.4 for place in PAST], [*[None] * 5, 1.0, 0.8]
    path = write_walk(tmp_path / "two.mcap", found, others)
    _, output = redact(path, what, found)
    for other, (colour, depth) in zip(others[5:], frames_of(output)[5:], strict=True):
        assert other is not None
        assert not depth[person_at(other)].any()
        assert colour[person_at(other)].max() < BLACK
        assert (depth > 0).mean() > 0.4


def test_legs_that_a_network_misplaces_are_hidden_by_their_depth(tmp_path: Path) -> None:
    def misplaced(x: float) -> FoundPerson:
        person = seen(standing(x))
        legs = [joint for joint in Joint if joint.name.startswith(("KNEE", "ANKLE", "FOOT"))]
        person.pixels[legs] -= [70.0, 0.0]
        return person

    path = write_walk(tmp_path / "stands.mcap", [0.0] * 3)
    network = ToldNetwork([[misplaced(0.0)]])
    output = tmp_path / "out.mcap"
    redact_recording(
        [path],
        output,
        "people",
        lambda: FaceFinder(ToldFaces(), network),  # type: ignore[arg-type]
    )
    for colour, depth in frames_of(output):
        assert not depth[person_at(0.0)].any()
        assert colour[person_at(0.0)].max() < BLACK
        assert (depth > 0).mean() > 0.5


def test_the_file_says_what_was_hidden_and_by_which_version_each_time(tmp_path: Path) -> None:
    path = write_walk(tmp_path / "walk.mcap", PAST)
    _, faceless = redact(path, "faces", PAST)
    _, output = redact(faceless, "people", PAST)
    examined = examine_recording(output)
    assert examined.problems == ()
    first, second = (line for line in examined.notes if "hidden by inhand " in line)
    assert "faces hidden" in first + second
    assert "people hidden" in first + second
    metadata = inspect_recording(output).metadata
    assert metadata["redaction"]["hidden"] == "people"
    assert metadata["redaction"]["frames"] == "7"
    assert metadata["redaction of faces.mcap"]["hidden"] == "faces"
    assert metadata["session"] == {"participant": "p01"}


def test_meshes_stay_attached_and_what_may_be_a_picture_does_not(tmp_path: Path) -> None:
    path = write_walk(tmp_path / "walk.mcap", [0.0])
    assert len(read_attachments(path)) == 2
    _, output = redact(path, "faces", [0.0])
    assert [one.name for one in read_attachments(output)] == ["objects/mug/mesh.ply"]


def test_damaged_frames_and_previews_of_no_frame_are_left_out_and_counted(tmp_path: Path) -> None:
    path, broken = write_walk(tmp_path / "walk.mcap", PAST), tmp_path / "broken.mcap"
    with RecordingWriter(broken) as writer:
        for message in read_recording(path):
            if message.topic is RGBD and message.sequence == 2:
                frame: RgbdFrame = RGBD.decode(message.payload)
                assert frame.colour is not None
                cut = replace(frame.colour, data=frame.colour.data[:40])
                write_beside(writer, message.key, message, RGBD.encode(replace(frame, colour=cut)))
            elif not (message.topic is RGBD and message.sequence == 4):
                copy_message(writer, message)
    done, output = redact(broken, "people", [*PAST[:2], PAST[3], *PAST[5:]])
    assert done.written.damaged == {"rgbd/front": 1}
    assert done.counts == {"frames": 5, "previews": 6, "previews left out": 1}
    assert [one.sequence for one in read_recording(output, streams=("rgbd",))] == [0, 1, 3, 5, 6]
    assert not previews_of(output)[2].any()
    assert examine_recording(output).problems == ()


def test_an_existing_file_is_never_touched_and_what_is_interrupted_never_looks_finished(
    tmp_path: Path,
) -> None:
    path = write_walk(tmp_path / "walk.mcap", PAST)
    with pytest.raises(RecordingError, match="exists already"):
        redact_recording([path], path, "people", told_finder(PAST))

    def interrupted(step: str, total: int) -> None:
        assert total in (7, 29)
        if step == "writing":
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        redact_recording([path], tmp_path / "out.mcap", "people", told_finder(PAST), interrupted)
    assert sorted(one.name for one in tmp_path.iterdir()) == ["out.mcap.redacting", "walk.mcap"]


def test_what_cannot_be_redacted_is_refused_with_the_mend(tmp_path: Path) -> None:
    def nobody() -> FaceFinder:
        raise AssertionError("nobody is looked for")

    bare = write_walk(tmp_path / "bare.mcap", [0.0], info=False)
    with pytest.raises(RecordingError, match="no info of front: `inhand recording repair`"):
        redact_recording([bare], tmp_path / "out.mcap", "faces", told_finder([0.0]))
    empty = write_walk(tmp_path / "empty.mcap", [])
    with pytest.raises(RecordingError, match="there are no pictures"):
        redact_recording([empty], tmp_path / "out.mcap", "faces", nobody)


def test_each_stream_is_redacted_or_known_to_show_no_pictures() -> None:
    assert {*WITHOUT_PICTURES, RGBD, PREVIEW} == set(TOPICS.values())
