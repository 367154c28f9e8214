"""Recordings that lack something are opened, say what they lack, and show what they have."""

from collections.abc import Callable, Iterable
from pathlib import Path

import msgspec
import numpy as np
import pytest
from changed_recordings import write_messages
from inhand_lab.labelling.keyframes import LabellingError
from inhand_lab.labelling.scene import load_scene
from inhand_runtime.recording import RecordingError
from inhand_schemas.messages import CameraInfo, Message, ObjectPose, RgbdFrame, Skeletons
from inhand_studio.labelling_page.opened import OpenedRecording
from waving import START_NS, messages

FRAMES = 12


def _opened(
    folder: Path, change: Callable[[Message], Message | None] = lambda one: one, **options: str
) -> OpenedRecording:
    changed: Iterable[Message | None] = map(change, messages(FRAMES, 0, images=True))
    return OpenedRecording(write_messages(folder / "wave.mcap", changed, **options))


def _without(kind: type[Message]) -> Callable[[Message], Message | None]:
    return lambda one: None if isinstance(one, kind) else one


def test_any_frame_shows_its_image_and_the_joints_of_the_labels(tmp_path: Path) -> None:
    recording = _opened(tmp_path)
    assert recording.unlabelled_because is None
    assert len(recording) == FRAMES
    image = recording.image(7)
    assert image is not None
    assert image.colour is not None
    scene = load_scene(recording.path, "camera")
    np.testing.assert_array_equal(recording.joints(range(FRAMES)), scene.joints)
    assert recording.label("box", 3) is not None
    assert recording.label("mug", 3) is None
    assert any("no depth" in note for note in recording.notes)


def test_without_skeletons_pictures_are_shown_and_not_labelled(tmp_path: Path) -> None:
    recording = _opened(tmp_path, _without(Skeletons))
    assert "inhand recording skeletons" in str(recording.unlabelled_because)
    assert len(recording) == FRAMES
    assert recording.image(7) is not None
    assert recording.people(7) == ()
    assert np.isnan(recording.joints([7])).all()


def test_without_pictures_it_is_labelled_by_the_skeleton_alone(tmp_path: Path) -> None:
    recording = _opened(tmp_path, _without(RgbdFrame))
    assert recording.unlabelled_because is None
    assert recording.image(7) is None
    assert any("no pictures" in note for note in recording.notes)


def test_without_the_cameras_info_nothing_is_labelled(tmp_path: Path) -> None:
    recording = _opened(tmp_path, _without(CameraInfo))
    assert "inhand recording repair" in str(recording.unlabelled_because)
    assert recording.image(7) is None


def test_a_picture_that_is_missing_or_damaged_leaves_its_frame_without_one(tmp_path: Path) -> None:
    def change(one: Message) -> Message | None:
        if not isinstance(one, RgbdFrame) or one.sequence not in (3, 5) or one.colour is None:
            return one
        if one.sequence == 3:
            return None
        return msgspec.structs.replace(one, colour=msgspec.structs.replace(one.colour, data=b"x"))

    recording = _opened(tmp_path, change)
    shown = [recording.image(frame) is not None for frame in range(FRAMES)]
    assert shown == [frame not in (3, 5) for frame in range(FRAMES)]


def test_of_two_cameras_one_is_chosen(tmp_path: Path) -> None:
    path = _opened(tmp_path, _without(ObjectPose), also="side").path
    assert OpenedRecording(path).cameras == ("camera", "side")
    assert OpenedRecording(path, "side").camera == "side"
    with pytest.raises(LabellingError, match="choose one of camera, side"):
        OpenedRecording(path, "back")


def test_half_a_file_is_shown_and_labelled_when_it_is_whole(tmp_path: Path) -> None:
    path = _opened(tmp_path).path
    part = path.with_name("wave.mcap.part")
    part.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    recording = OpenedRecording(part)
    assert "inhand recording recover" in str(recording.unlabelled_because)
    assert 0 < len(recording) <= FRAMES
    assert recording.times_ns[0] == START_NS
    assert recording.image(0) is not None


@pytest.mark.parametrize("text", [b"", b"no recording"])
def test_what_is_no_recording_is_refused(tmp_path: Path, text: bytes) -> None:
    path = tmp_path / "wave.mcap"
    path.write_bytes(text)
    with pytest.raises(RecordingError):
        OpenedRecording(path)


def test_a_recording_of_nothing_is_refused(tmp_path: Path) -> None:
    path = write_messages(tmp_path / "wave.mcap", [])
    with pytest.raises(LabellingError, match="no skeletons and no pictures"):
        OpenedRecording(path)
