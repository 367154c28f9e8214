"""Training and evaluation follow whom the labels name."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from changed_recordings import replace, write_recording
from inhand_lab.datasets.dataset import Dataset, DatasetError
from inhand_lab.datasets.labelled_sequence import labelled_sequence
from inhand_lab.datasets.observations import observe
from inhand_lab.datasets.recorded_frames import load_frames
from inhand_lab.training.recorded_movements import read_joints
from inhand_lab.training.recording_checks import check_sequence
from inhand_schemas.messages import Message, ObjectPose, Person, Skeletons
from inhand_tracker.wire.conversion import joints_of
from waving import entry_of, waving

USER, BYSTANDERS = 1, (7, 9)
Named = Callable[[int], int | None]


def crowd(one: Person) -> tuple[Person, ...]:
    """Two people who stand nearer to the camera, and the one who waves the box last."""
    bystanders = (
        replace(one, id=number, joints=tuple((x + 1.0, y, z - 0.4 * k) for x, y, z in one.joints))
        for k, number in enumerate(BYSTANDERS, start=1)
    )
    return *bystanders, one


def crowded(named: Named, alone: tuple[int, ...] = ()) -> Callable[[Message], Message]:
    """Bystanders in every frame; the user is missing in the frames of ``alone``."""

    def change(message: Message) -> Message:
        if isinstance(message, Skeletons):
            people = crowd(message.people[0])
            return replace(message, people=people[:2] if message.sequence in alone else people)
        if isinstance(message, ObjectPose):
            return replace(message, person=named(message.sequence))
        return message

    return change


def followed_joints(folder: Path, change: Callable[[Message], Message]) -> list[np.ndarray]:
    """Joints of all frames as each reader of recordings takes them."""
    entry = entry_of("p0")
    (folder / "recordings").mkdir()
    dataset = Dataset(folder, (entry,))
    path = write_recording(dataset.path(entry), change)
    frames = load_frames(path, "box")
    nobody = np.full((20, 3), np.nan)
    seen = [nobody if one.joints is None else one.joints for one in observe(path, frames)]
    return [
        labelled_sequence(dataset, entry).joints,
        read_joints(dataset, entry).joints,
        np.array(seen),
    ]


@pytest.mark.parametrize(
    "named",
    [lambda _: USER, lambda n: USER if n % 5 == 3 else None],
    ids=["in every label", "in some labels"],
)
def test_whom_the_label_names_is_followed_whoever_stands_nearer(
    named: Named, tmp_path: Path
) -> None:
    for joints in followed_joints(tmp_path, crowded(named)):
        np.testing.assert_allclose(joints, waving(30, 0)[0])


def test_nobody_stands_in_for_the_named_person_who_is_out_of_view(tmp_path: Path) -> None:
    for joints in followed_joints(tmp_path, crowded(lambda _: USER, alone=(0, 4, 5))):
        assert np.isnan(joints[[0, 4, 5]]).all()
        assert np.isfinite(joints[[1, 2, 3, 6]]).all()


def test_who_is_named_next_is_followed_from_there_on_as_somebody_else(tmp_path: Path) -> None:
    path = write_recording(tmp_path / "a.mcap", crowded(lambda n: USER if n < 9 else 7))
    frames = load_frames(path, "box")
    seen = list(observe(path, frames))
    assert [n for n, one in enumerate(seen) if one.somebody_else] == [0, 9]
    assert seen[9].joints is not None
    np.testing.assert_array_equal(seen[9].joints, joints_of(frames[9].people[0]))


def test_an_object_that_passes_to_another_person_is_learned_of_the_one_who_has_it_most(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    joints, *_ = followed_joints(tmp_path, crowded(lambda n: USER if n < 20 else 7))
    np.testing.assert_allclose(joints[:20], waving(30, 0)[0][:20])
    assert np.isnan(joints[20:]).all()
    assert "passes from one person to another: 10 of 30 frames" in caplog.text
    sequence = labelled_sequence(Dataset(tmp_path, (entry_of("p0"),)), entry_of("p0"))
    assert np.isnan(sequence.translations[20:]).all()
    check_sequence(entry_of("p0"), sequence)


def test_one_person_whom_a_tracker_numbers_anew_is_one_person(tmp_path: Path) -> None:
    def renumbered(message: Message) -> Message:
        if isinstance(message, Skeletons):
            return replace(message, people=(replace(message.people[0], id=message.sequence // 10),))
        if isinstance(message, ObjectPose):
            return replace(message, person=message.sequence // 10)
        return message

    for joints in followed_joints(tmp_path, renumbered):
        np.testing.assert_allclose(joints, waving(30, 0)[0])


def test_without_a_name_the_nearest_is_followed_as_a_tracker_does(tmp_path: Path) -> None:
    path = write_recording(tmp_path / "a.mcap", crowded(lambda _: None))
    frames = load_frames(path, "box")
    (first, *_) = observe(path, frames)
    assert first.joints is not None
    np.testing.assert_array_equal(first.joints, joints_of(frames[0].people[1]))


def test_a_label_that_names_nobody_who_is_seen_is_refused(tmp_path: Path) -> None:
    path = write_recording(tmp_path / "a.mcap", crowded(lambda _: 0))
    with pytest.raises(DatasetError, match="labels name person 0, and the skeletons have 1, 7, 9"):
        load_frames(path, "box")
