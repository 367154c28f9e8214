"""Training a recogniser of actions from a dataset."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.recognition.movement_classes import MovementClasses
from inhand_tracker.recognition.presence import usual_presence
from inhand_tracker.recognition.recogniser import Recogniser

from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.people.joint_sequence import JointSequence
from inhand_lab.training.movement_training import MovementSequence, train_movements
from inhand_lab.training.svm_training import train_svm
from inhand_lab.training.watched_people import poses_and_movements, usual_poses, watch
from inhand_lab.world.idle_people import Idleness, watch_idle

STEP = 4
"""Every so many-th body is learned from: successive ones are much the same."""
KEPT_POSES = 1000
IDLE_PEOPLE, IDLE_SEED, IDLE_STEP = 16, 7, 6
IDLE_KINDS: tuple[Idleness, ...] = ("fidget", "stand", "walkOnSpot", "walkAbout")
"""Simulated people who use nothing, of whom every recogniser learns."""
READING, LEARNING = "recordings", "actions"


def stages(recordings: int) -> dict[str, int]:
    """What training goes through, each with the number of its steps."""
    return {READING: recordings, LEARNING: 1}


def train_recogniser(
    dataset: Dataset,
    entries: Sequence[DatasetEntry],
    on_step: Callable[[str], None] = lambda stage: None,
) -> Recogniser:
    """Learn the actions of recordings, labelled or not; raises DatasetError or RecordingError.

    ``on_step`` is called at every step of ``stages``.
    """
    people = []
    for entry in entries:
        people.append(_watched(dataset, entry))
        on_step(READING)
    recogniser = recogniser_of(people, str(dataset.folder))
    on_step(LEARNING)
    return recogniser


def recogniser_of(people: Sequence[JointSequence], named: str = "the recordings") -> Recogniser:
    """Learn the actions of people; ``named`` is where they are from, for the error.

    Raises DatasetError.
    """
    learned = learn_movements(people, named)
    svm = train_svm(learned.poses, learned.labels)
    presence = usual_presence(len(learned.actions))
    return Recogniser(
        learned.actions, learned.body_poses, svm, learned.movements, learned.temper, presence
    )


@dataclass(frozen=True)
class LearnedMovements:
    """``movements``, their ``temper``, and the body poses (N, 60) and actions (N,) learned from."""

    actions: tuple[str, ...]
    movements: MovementClasses
    temper: float
    poses: Array
    labels: Indices

    @property
    def body_poses(self) -> Array:
        """(M, 60): some of the poses, for a recogniser to keep."""
        return self.poses[:: max(1, len(self.poses) // KEPT_POSES)]


def learn_movements(
    people: Sequence[JointSequence], named: str = "the recordings"
) -> LearnedMovements:
    """What ``recogniser_of`` learns, without the support vector machine; raises DatasetError."""
    actions = tuple(dict.fromkeys(one.action for one in people))
    participants = {one.participant for one in people}
    if len(actions) < 2 or len(participants) < 2:
        raise DatasetError(
            f"{named}: {len(actions)} actions by {len(participants)} participants: recognition "
            "compares two actions at the least, by two participants at the least"
        )
    usual = usual_poses(people)
    poses, labels, sequences = [], [], list(_background(len(actions)))
    for one in people:
        theirs, features, frames = poses_and_movements(one, usual, STEP)
        if not len(frames):
            continue
        number = actions.index(one.action)
        poses.append(theirs)
        labels.append(np.full(len(theirs), number))
        sequences.append(MovementSequence(number, one.participant, features, one.times_ns[frames]))
    missing = set(range(len(actions))) - {one.action for one in sequences}
    if missing:
        raise DatasetError(f"{named}: no body is seen doing {actions[min(missing)]!r}")
    movements, temper = train_movements(sequences, len(actions))
    return LearnedMovements(
        actions, movements, temper, np.concatenate(poses), np.concatenate(labels)
    )


@lru_cache(maxsize=4)
def _background(number: int) -> list[MovementSequence]:
    """People who use nothing, as the class of that number."""
    people = [
        watch_idle(idleness, participant, IDLE_SEED)
        for participant in range(IDLE_PEOPLE)
        for idleness in IDLE_KINDS
    ]
    usual = usual_poses(people)
    sequences = []
    for one in people:
        _, features, frames = poses_and_movements(one, usual, IDLE_STEP)
        named = f"idle {one.participant}"
        sequences.append(MovementSequence(number, named, features, one.times_ns[frames]))
    return sequences


# Folds share recordings.
@lru_cache(maxsize=512)
def _watched(dataset: Dataset, entry: DatasetEntry) -> JointSequence:
    return watch(dataset, entry)
