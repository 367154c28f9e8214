"""What is learned from and what is tested."""

from pathlib import Path

import pytest
from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.datasets.stretches import RecordingStretch
from inhand_lab.evaluation.folds import (
    Added,
    leave_one_out,
    leave_out,
    train_on_one_test_on_other,
)
from waving import write_dataset


def entry(
    name: str, participant: str, interaction: str = "wave", thing: str | None = "box"
) -> DatasetEntry:
    return DatasetEntry(file=name, interaction=interaction, participant=participant, object=thing)


def dataset(*entries: DatasetEntry) -> Dataset:
    return Dataset(Path("somewhere"), entries)


def test_every_participant_is_left_out_once_and_never_learned_from() -> None:
    folds = leave_one_out(
        dataset(*(entry(f"{p}{n}", p) for p in ("a", "b", "c") for n in range(2)))
    )
    assert [{e.participant for e in fold.tested} for fold in folds] == [{"a"}, {"b"}, {"c"}]
    assert all(len(fold.tested) == 2 and len(fold.trained) == 4 for fold in folds)
    for fold in folds:
        tested = {e.participant for e in fold.tested}
        assert tested.isdisjoint(e.participant for e in fold.trained)


def test_of_a_single_participant_every_recording_is_left_out_once() -> None:
    folds = leave_one_out(dataset(*(entry(f"swing{n}", "a") for n in range(5))))
    assert [fold.tested[0].file for fold in folds] == [f"swing{n}" for n in range(5)]
    assert all(len(fold.trained) == 4 for fold in folds)


def test_every_two_of_five_recordings_are_left_out_together_once() -> None:
    swings = [f"swing{n}" for n in range(5)]
    folds = leave_out(dataset(*(entry(name, "a") for name in swings)), 2)
    assert len(folds) == 10
    assert len({tuple(e.file for e in fold.tested) for fold in folds}) == 10
    for fold in folds:
        assert sorted(e.file for e in (*fold.tested, *fold.trained)) == swings


def test_leaving_everybody_out_is_refused_in_one_line() -> None:
    with pytest.raises(DatasetError, match="wave has 2 participants, and nothing is left to learn"):
        leave_out(dataset(entry("a", "a"), entry("b", "b")), 2)


def test_interactions_are_kept_apart_and_unlabelled_recordings_left_out() -> None:
    folds = leave_one_out(
        dataset(
            *(entry(f"w{p}", p) for p in "abc"),
            *(entry(f"s{p}", p, "sweep", "broom") for p in "abc"),
            entry("idle", "d", "wave", None),
        )
    )
    assert [fold.interaction for fold in folds] == ["wave"] * 3 + ["sweep"] * 3
    assert all(len(fold.trained) == 2 for fold in folds)


def frames_of(fold_entry: DatasetEntry) -> tuple[int, int]:
    assert isinstance(fold_entry, RecordingStretch)
    return fold_entry.first, fold_entry.end


def test_of_a_single_recording_every_stretch_is_left_out_once(tmp_path: Path) -> None:
    folds = leave_one_out(write_dataset(tmp_path, 1, frames=600))
    assert [frames_of(fold.tested[0]) for fold in folds] == [(0, 170), (230, 370), (430, 600)]
    for fold in folds:
        first, end = frames_of(fold.tested[0])
        assert len(fold.trained) == 2
        for trained in map(frames_of, fold.trained):
            assert trained[1] + 60 <= first or end + 60 <= trained[0]


def test_a_single_recording_that_is_left_to_learn_from_is_cut(tmp_path: Path) -> None:
    made = write_dataset(tmp_path, 2, frames=400)
    for fold, other in zip(leave_one_out(made), reversed(made.entries), strict=True):
        assert not isinstance(fold.tested[0], RecordingStretch)
        assert [frames_of(one) for one in fold.trained] == [(0, 170), (230, 400)]
        assert {one.file for one in fold.trained} == {other.file}


def test_a_short_recording_is_refused_with_the_seconds_that_are_needed(tmp_path: Path) -> None:
    with pytest.raises(DatasetError, match=r"6\.7 s of it have .* 3 stretches, which takes 19 s"):
        leave_one_out(write_dataset(tmp_path / "one", 1, frames=200))
    with pytest.raises(DatasetError, match=r"6\.7 s of it have .* 2 stretches, which takes 12 s"):
        leave_one_out(write_dataset(tmp_path / "two", 2, frames=200))


def test_nothing_labelled_is_refused() -> None:
    with pytest.raises(DatasetError, match="no labelled interaction"):
        leave_one_out(dataset(entry("a", "a", thing=None)))


def test_one_interaction_with_two_objects_is_refused() -> None:
    entries = [entry(p, p, thing="mug" if p == "a" else "cup") for p in "abc"]
    with pytest.raises(DatasetError, match=r"wave is done with 2 objects \(cup, mug\)"):
        leave_one_out(dataset(*entries))


def test_all_of_one_set_is_learned_and_all_of_the_other_tested() -> None:
    trained = dataset(*(entry(p, p) for p in "ab"), *(entry(p, p, "sweep", "broom") for p in "ab"))
    tested = dataset(*(entry(p, p) for p in "ade"))
    (fold,) = train_on_one_test_on_other(trained, tested)
    assert (fold.tested, fold.trained) == (tested.entries, trained.entries[:2])


def test_sets_that_share_nothing_are_refused_with_what_they_have() -> None:
    trained, tested = dataset(entry("a", "a")), dataset(entry("a", "a", "sweep", "broom"))
    with pytest.raises(DatasetError, match="the one has wave, the other sweep"):
        train_on_one_test_on_other(trained, tested)


def test_who_is_added_is_learned_from_and_not_tested() -> None:
    trained = dataset(entry("a1", "a"), entry("b1", "b"))
    tested = dataset(*(entry(f"{p}{n}", p) for p in ("s1", "s2") for n in range(3)))
    (fold,) = train_on_one_test_on_other(trained, tested, [Added("s1", 2)])
    assert [e.file for e in fold.added] == ["s10", "s11"]
    assert {e.participant for e in fold.tested} == {"s2"}
    assert {e.participant for e in fold.trained} == {"a", "b"}


def test_somebody_who_is_not_there_cannot_be_added_nor_can_everybody() -> None:
    trained = dataset(entry("a1", "a"), entry("b1", "b"))
    tested = dataset(entry("s", "s1"), entry("t", "s2"))
    with pytest.raises(DatasetError, match="no participant 's3' with wave; there are: s1, s2"):
        train_on_one_test_on_other(trained, tested, [Added("s3")])
    with pytest.raises(DatasetError, match="nobody else to test"):
        train_on_one_test_on_other(trained, tested, [Added("s1"), Added("s2")])
