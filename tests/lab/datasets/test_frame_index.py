"""Frames of a recording by their numbers, the same as those that are read in order."""

from pathlib import Path

import numpy as np
import pytest
from changed_recordings import replace, write_messages
from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.datasets.followed_people import follow_people
from inhand_lab.datasets.frame_index import open_frames
from inhand_lab.datasets.frame_pixels import pixels_of
from inhand_lab.datasets.recorded_frames import load_camera_info, load_frames
from inhand_lab.labelling.keyframes import LabellingError
from inhand_lab.labelling.scene import joints_between, load_scene
from inhand_schemas.messages import Message, RgbdFrame
from inhand_tracker.wire.conversion import joints_of
from waving import messages

FRAMES = 12


def changed(how: str) -> list[Message]:
    """A recording whose pixels are not simply one of each frame."""
    shown = list(messages(FRAMES, 0, images=True))
    images = [index for index, one in enumerate(shown) if isinstance(one, RgbdFrame)]
    if how == "rounded times":
        for index in images:
            shown[index] = replace(shown[index], time_ns=shown[index].time_ns // 10**7 * 10**7)
    elif how == "lost":
        del shown[images[5]], shown[images[3]]
    elif how == "twice":
        shown.insert(images[5] + 1, shown[images[5]])
    elif how == "of no frame":
        shown[images[5]] = replace(shown[images[5]], sequence=999, time_ns=shown[0].time_ns + 1)
    return shown


@pytest.mark.parametrize("how", ["whole", "rounded times", "lost", "twice", "of no frame"])
def test_frames_are_those_that_are_read_in_order(how: str, tmp_path: Path) -> None:
    path = write_messages(tmp_path / "wave.mcap", changed(how))
    read = load_frames(path, None, "camera")
    pixels = dict(pixels_of(path, read, "camera"))
    with open_frames(path) as frames:
        assert frames.camera_info() == load_camera_info(path)
        assert [frame.time_ns for frame in read] == frames.times_ns.tolist()
        for number in reversed(range(FRAMES)):
            assert frames.skeletons(number).people == read[number].people
            assert frames.pixels(number) == pixels.get(number)
        assert len(frames.messages("label", "box")) == FRAMES
        assert frames.nearest(int(frames.times_ns[4]) + 1000) == 4


def test_a_scene_follows_whom_a_tracker_would(tmp_path: Path) -> None:
    path = write_messages(tmp_path / "wave.mcap", messages(FRAMES, 0))
    scene, read = load_scene(path, "camera"), load_frames(path, None, "camera")
    followed = [one.person for one in follow_people(read)]
    expected = np.array([joints_of(person) for person in followed if person is not None])
    np.testing.assert_array_equal(scene.joints, expected)
    assert [stamp.sequence for stamp in scene.frames] == [frame.sequence for frame in read]
    with open_frames(path) as frames:
        np.testing.assert_array_equal(joints_between(frames, 3, 7), expected[3:8])


def test_a_camera_that_is_not_to_be_had_is_told(tmp_path: Path) -> None:
    path = write_messages(tmp_path / "wave.mcap", messages(FRAMES, 0))
    line = "no skeletons of camera 'attic': choose one of camera"
    with pytest.raises(DatasetError, match=line), open_frames(path, "attic"):
        pass
    bare = [one for one in changed("whole") if isinstance(one, RgbdFrame)]
    path = write_messages(tmp_path / "bare.mcap", bare)
    line = "holds no skeletons: `inhand recording skeletons`"
    with pytest.raises(DatasetError, match=line), open_frames(path):
        pass


def test_half_a_file_shows_its_frames_and_is_not_labelled(tmp_path: Path) -> None:
    whole = write_messages(tmp_path / "wave.mcap", changed("whole"))
    path = tmp_path / "half.mcap"
    path.write_bytes(whole.read_bytes()[: whole.stat().st_size // 2])
    with open_frames(path) as frames:
        assert 0 < len(frames) < FRAMES
        assert frames.note is not None
        assert frames.pixels(0) is not None
    with pytest.raises(LabellingError, match="inhand recording recover"):
        load_scene(path, "camera")
