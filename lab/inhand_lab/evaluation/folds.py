"""Folds: recordings to learn from, and others to test."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.datasets.stretches import RecordingStretch, stretches_of
from inhand_lab.training.model_training import FEWEST_LEARNED


@dataclass(frozen=True)
class Fold:
    """The recordings of one interaction that are tested, and those that are learned from.

    Where one recording is all there is to learn from, they are stretches. Those that are ``added``
    are of the dataset that is tested, of people who are not, and adapt what is learned.
    """

    interaction: str
    tested: tuple[DatasetEntry, ...]
    trained: tuple[DatasetEntry, ...]
    added: tuple[DatasetEntry, ...] = ()


def leave_one_out(dataset: Dataset) -> list[Fold]:
    """Leave out one participant a fold, as ``leave_out`` does; raises DatasetError."""
    return leave_out(dataset, 1)


def leave_out(dataset: Dataset, count: int) -> list[Fold]:
    """Leave out every choice of ``count`` participants, or recordings of a single participant, a
    fold each.

    Of a single recording stretches are left out. Where one recording is left to learn from, it is
    cut into stretches. Raises DatasetError where it is too short, or nobody would be left.
    """
    folds = []
    for interaction in dataset.interactions():
        entries = _labelled(dataset, interaction)
        if len(entries) == 1:
            entries = stretches_of(dataset, entries[0], FEWEST_LEARNED + count)
        participants = sorted({entry.participant for entry in entries})
        groups = (
            [[e for e in entries if e.participant == participant] for participant in participants]
            if len(participants) > 1
            else [[entry] for entry in entries]
        )
        if 0 < len(groups) <= count:
            who = "participants" if len(participants) > 1 else "recordings"
            raise DatasetError(
                f"{dataset.folder}: {interaction} has {len(groups)} {who}, and nothing is left to "
                f"learn from without {count} of them: leave out fewer"
            )
        for chosen in combinations(groups, count):
            tested = tuple(entry for group in chosen for entry in group)
            rest = tuple(entry for entry in entries if entry not in tested)
            folds.append(Fold(interaction, tested, _enough(dataset, rest)))
    return _checked(folds, dataset)


@dataclass(frozen=True)
class Added:
    """A participant of the tested dataset who is learned from, by the first ``recordings`` of each
    interaction, or by all of them (None)."""

    participant: str
    recordings: int | None = None


def train_on_one_test_on_other(
    trained: Dataset, tested: Dataset, added: Sequence[Added] = ()
) -> list[Fold]:
    """Make a fold of each interaction: all recordings of one set to learn from, all of the other to
    test; but for those of people who are ``added`` to what is learned.

    Raises DatasetError where they share no interaction, or nobody of that name is there, or nobody
    else.
    """
    folds = []
    for interaction in tested.interactions():
        entries = _labelled(tested, interaction)
        names = [one.participant for one in added]
        more = tuple(
            entry
            for one in added
            for entry in [e for e in entries if e.participant == one.participant][: one.recordings]
        )
        left = tuple(entry for entry in entries if entry.participant not in names)
        enough = _enough(trained, _labelled(trained, interaction))
        folds.append(Fold(interaction, left, enough, more))
    shared = [fold for fold in folds if fold.trained]
    if not shared:
        raise DatasetError(
            f"{trained.folder} and {tested.folder} share no labelled interaction: the one has "
            f"{_named(trained.interactions())}, the other {_named(tested.interactions())}"
        )
    _check_added(shared, tested, added)
    return _checked(shared, trained)


def _check_added(folds: Sequence[Fold], tested: Dataset, added: Sequence[Added]) -> None:
    for fold in folds:
        entries = (*fold.tested, *fold.added)
        people = sorted({entry.participant for entry in entries})
        there = {entry.participant for entry in fold.added}
        for one in added:
            if one.participant not in there:
                raise DatasetError(
                    f"{tested.folder} has no participant {one.participant!r} with "
                    f"{fold.interaction}; there are: {', '.join(people)}"
                )
        if not fold.tested:
            raise DatasetError(
                f"{tested.folder} has nobody else to test with {fold.interaction}: add fewer"
            )


def _labelled(dataset: Dataset, interaction: str) -> tuple[DatasetEntry, ...]:
    return tuple(e for e in dataset.entries if e.interaction == interaction and e.object)


def _enough(dataset: Dataset, trained: tuple[DatasetEntry, ...]) -> tuple[DatasetEntry, ...]:
    """Return the recordings, or where there is one only its stretches; raises DatasetError."""
    if len(trained) == 1 and not isinstance(trained[0], RecordingStretch):
        return stretches_of(dataset, trained[0], FEWEST_LEARNED)
    return trained


def _checked(folds: list[Fold], dataset: Dataset) -> list[Fold]:
    if not folds:
        raise DatasetError(f"{dataset.folder} has no labelled interaction to evaluate")
    for fold in folds:
        objects = sorted(
            {str(entry.object) for entry in (*fold.trained, *fold.added, *fold.tested)}
        )
        if len(objects) > 1:
            raise DatasetError(
                f"{dataset.folder}: {fold.interaction} is done with {len(objects)} objects "
                f"({', '.join(objects)}): give each its own interaction's name"
            )
    return folds


def _named(interactions: Sequence[str]) -> str:
    return ", ".join(interactions) or "none"
