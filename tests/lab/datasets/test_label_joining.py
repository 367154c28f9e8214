"""Labels meet their frames, or the recording is refused with what keeps them apart."""

from pathlib import Path

import pytest
from changed_recordings import replace, with_labels, write_recording
from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.datasets.recorded_frames import load_frames
from inhand_schemas.messages import ObjectPose, Skeletons
from waving import FRAME_NS

SAME_FRAME = {
    "1 ms late": lambda one: replace(one, time_ns=one.time_ns + 10**6),
    "1 ms early": lambda one: replace(one, time_ns=one.time_ns - 10**6),
    "whole microseconds": lambda one: replace(one, time_ns=one.time_ns // 10**3 * 10**3),
    "whole centiseconds": lambda one: replace(one, time_ns=one.time_ns // 10**7 * 10**7),
    "one of many": lambda one: replace(one, time_ns=one.time_ns + (one.sequence == 7) * 10**6),
}


@pytest.mark.parametrize("what", SAME_FRAME)
def test_a_label_is_of_the_frame_of_its_number_at_about_its_time(what: str, tmp_path: Path) -> None:
    path = write_recording(tmp_path / "a.mcap", with_labels(SAME_FRAME[what]))
    frames = load_frames(path, "box")
    assert [frame.label and frame.label.sequence for frame in frames] == list(range(30))


APART = {
    "a frame late": (
        lambda one: replace(one, time_ns=one.time_ns + 50 * 10**6),
        r"30 of 30 labels of 'box' are of no frame: the nearest .* ms away and differs by",
    ),
    "numbered from 1": (
        lambda one: replace(one, sequence=one.sequence + 1),
        r"is at its time and differs by \+1 in sequence, in the median; write sequence",
    ),
    "in milliseconds": (
        lambda one: replace(one, time_ns=one.time_ns // 10**6),
        r"30 of 30 labels of 'box' are of no frame",
    ),
    "of another name": (
        lambda one: replace(one, object="carton"),
        r"holds labels of 'carton', and dataset.toml says object = 'box'",
    ),
}


@pytest.mark.parametrize("what", APART)
def test_labels_of_no_frame_are_counted_and_compared(what: str, tmp_path: Path) -> None:
    change, message = APART[what]
    path = write_recording(tmp_path / "a.mcap", with_labels(change))
    with pytest.raises(DatasetError, match=message) as caught:
        load_frames(path, "box")
    assert str(caught.value).startswith(str(path))


def test_labels_of_frames_that_were_lost_are_passed_over(tmp_path: Path) -> None:
    path = write_recording(
        tmp_path / "a.mcap",
        lambda one: None if isinstance(one, Skeletons) and one.sequence % 4 else one,
    )
    frames = load_frames(path, "box")
    assert len(frames) == 8
    assert all(frame.label is not None for frame in frames)


def test_of_two_labels_of_a_frame_the_nearer_in_time_is_taken(tmp_path: Path) -> None:
    (first, *_) = load_frames(write_recording(tmp_path / "a.mcap", lambda one: one), "box")
    assert first.label is not None

    def change(one: object) -> ObjectPose:
        assert isinstance(one, ObjectPose)
        at_first = one.sequence == 1
        return replace(one, sequence=0, time_ns=first.time_ns + FRAME_NS // 3) if at_first else one

    path = write_recording(tmp_path / "b.mcap", with_labels(change))
    assert load_frames(path, "box")[0].label == first.label
