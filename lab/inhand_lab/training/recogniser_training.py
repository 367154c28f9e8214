"""Trains a recogniser of actions from a dataset, or from people's joints."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from inhand_runtime.recording import RecordingError
from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.recognition.movement_classes import MovementClasses
from inhand_tracker.recognition.presence import usual_presence
from inhand_tracker.recognition.recogniser import Recogniser

from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.people.joint_sequence import JointSequence
from inhand_lab.training.model_training import OnRefused
from inhand_lab.training.movement_gaussians import MovementSequence
from inhand_lab.training.movement_training import train_movements
from inhand_lab.training.parameters import DEFAULT_TRAINING
from inhand_lab.training.recorded_movements import (
    RecordedMovement,
    UsualPoses,
    read_joints,
    read_movement,
    usual_poses,
)
from inhand_lab.training.svm_training import train_svm
from inhand_lab.world.idle_people import watch_idle

READING, LEARNING = "recordings", "actions"


NOTHING = "none"
"""Action of people who use nothing."""


def recogniser_stages(recordings: int) -> dict[str, int]:
    """Name the stages of training a recogniser, each with the number of its steps."""
    return {READING: recordings, LEARNING: 1}


def train_recogniser(
    dataset: Dataset,
    entries: Sequence[DatasetEntry],
    on_step: Callable[[str], None] = lambda stage: None,
    on_refused: OnRefused | None = None,
) -> Recogniser:
    """Learn the actions of recordings; raises DatasetError or RecordingError.

    Where some are labelled, those of other interactions without an object are of people who use
    nothing. Where none is, each interaction is an action.

    ``on_step`` is called at every step of ``recogniser_stages``. Recordings that cannot be read are
    passed over, and ``on_refused`` called for each; without it they are errors.
    """
    used = {entry.interaction for entry in entries if entry.object is not None}
    people = []
    for entry in entries:
        try:
            one = _read_joints(dataset, entry)
        except (DatasetError, RecordingError) as error:
            if on_refused is None:
                raise
            on_refused(entry, error)
            on_step(READING)
            continue
        uses_nothing = bool(used) and entry.interaction not in used
        people.append(replace(one, action=NOTHING) if uses_nothing else one)
        on_step(READING)
    recogniser = learn_recogniser(people, str(dataset.folder))
    on_step(LEARNING)
    return recogniser


def learn_recogniser(people: Sequence[JointSequence], origin: str = "the recordings") -> Recogniser:
    """Learn the actions of people; ``origin`` names where they are from, for the error.

    Raises DatasetError.
    """
    learned = learn_movements(people, origin)
    return Recogniser(
        actions=learned.actions,
        body_poses=learned.body_poses,
        svm=train_svm(learned.poses, learned.labels),
        movements=learned.movements,
        temper=learned.temper,
        presence=usual_presence(len(learned.actions)),
    )


@dataclass(frozen=True)
class LearnedMovements:
    """What is learned of ``actions`` (K), and the body ``poses`` (N, 60) it was learned from, with
    the number of the action of each as ``labels`` (N,)."""

    actions: tuple[str, ...]
    movements: MovementClasses
    temper: float
    poses: Array
    labels: Indices

    @property
    def body_poses(self) -> Array:
        """Body poses (M, 60) that a recogniser keeps, evenly spaced."""
        return self.poses[:: max(1, len(self.poses) // DEFAULT_TRAINING.kept_poses)]


def learn_movements(
    people: Sequence[JointSequence], origin: str = "the recordings"
) -> LearnedMovements:
    """Learn actions without the support vector machine; raises DatasetError.

    People whose action is ``NOTHING`` teach, as simulated idle ones do, what none is.
    """
    actions = tuple(dict.fromkeys(one.action for one in people if one.action != NOTHING))
    people = _apart(people, origin)
    usual = usual_poses(people)
    poses, labels, sequences = [], [], list(_idle_movements(len(actions)))
    for one in people:
        step = min(DEFAULT_TRAINING.body_step, len(one.joints) // DEFAULT_TRAINING.least_bodies)
        read = read_movement(one, usual, max(step, 1))
        if not len(read.frames):
            continue
        number = len(actions) if one.action == NOTHING else actions.index(one.action)
        if number < len(actions):
            poses.append(read.body_poses)
            labels.append(np.full(len(read.frames), number))
        sequences.append(_sequence(one, read, number, one.participant))
    missing = set(range(len(actions))) - {one.action for one in sequences}
    if missing:
        raise DatasetError(f"{origin}: no body is seen doing {actions[min(missing)]!r}")
    movements, temper = train_movements(sequences, len(actions))
    return LearnedMovements(
        actions, movements, temper, np.concatenate(poses), np.concatenate(labels)
    )


def _apart(people: Sequence[JointSequence], origin: str) -> list[JointSequence]:
    """The recordings such that each participant can be left out once; where there is one alone,
    whose recordings must stand for others, each counts as somebody's.

    Raises DatasetError where nobody would be left who does an action.
    """
    if len({one.participant for one in people}) > 1:
        return list(people)
    for action in dict.fromkeys(one.action for one in people if one.action != NOTHING):
        if sum(one.action == action for one in people) < 2:
            raise DatasetError(
                f"{origin}: one recording of {action!r} by one person: what is learned is checked "
                "on a recording that was left out, so make another one"
            )
    return [
        replace(one, participant=f"{one.participant}, recording {number}")
        for number, one in enumerate(people)
    ]


@lru_cache(maxsize=4)
def _idle_movements(action: int) -> list[MovementSequence]:
    """Simulate people who use nothing, whose class has the number ``action``."""
    people = [
        watch_idle(kind, participant, DEFAULT_TRAINING.idle_seed)
        for participant in range(DEFAULT_TRAINING.idle_people)
        for kind in DEFAULT_TRAINING.idle_kinds
    ]
    usual = usual_poses(people)
    return [_idle_movement(one, usual, action) for one in people]


def _idle_movement(one: JointSequence, usual: UsualPoses, action: int) -> MovementSequence:
    read = read_movement(one, usual, DEFAULT_TRAINING.idle_step)
    return _sequence(one, read, action, f"idle {one.participant}")


def _sequence(
    one: JointSequence, read: RecordedMovement, action: int, participant: str
) -> MovementSequence:
    times_ns = one.times_ns[read.frames]
    return MovementSequence(action, participant, read.features, times_ns, read.arms)


# Folds share recordings.
@lru_cache(maxsize=512)
def _read_joints(dataset: Dataset, entry: DatasetEntry) -> JointSequence:
    return read_joints(dataset, entry)
