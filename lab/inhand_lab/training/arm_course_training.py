"""Learns the courses that arms take in the recordings of each action."""

from collections.abc import Sequence
from itertools import chain, zip_longest

import numpy as np
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.recognition.arm_courses import MIRROR, ArmCourses
from inhand_tracker.recognition.arm_movement import OBSERVATION, WRISTS
from inhand_tracker.recognition.parameters import DEFAULT_RECOGNITION

from inhand_lab.training.movement_gaussians import MovementSequence
from inhand_lab.training.parameters import DEFAULT_TRAINING, TrainingParameters


def learn_courses(
    sequences: Sequence[MovementSequence],
    actions: int,
    parameters: TrainingParameters = DEFAULT_TRAINING,
) -> ArmCourses:
    """Keep the arms of recordings of all actions, of every participant of each one in turn."""
    courses, owners = [np.empty((0, OBSERVATION))], []
    for action in range(actions):
        ours = [one for one in sequences if one.action == action]
        used = [arms_in_use(one.arms, parameters.hanging_reach) for one in _in_turn(ours)]
        moved = [some for some in used if len(some)][: parameters.courses]
        courses += moved
        owners += [action] * len(moved)
    lengths = np.array([len(some) for some in courses[1:]], np.int64)
    return ArmCourses(np.concatenate(courses), lengths, np.array(owners, np.int64))


def arms_in_use(arms: Array, reach: float = DEFAULT_TRAINING.hanging_reach) -> Array:
    """Leave out of observations (M, 18) how both arms hang at first and at last; one stays."""
    hanging = np.array(DEFAULT_RECOGNITION.arms.hanging_wrist)
    wrists = arms[:, WRISTS].reshape(-1, 2, 3) - np.stack((hanging, MIRROR * hanging))
    used = np.flatnonzero((np.linalg.norm(wrists, axis=2) > reach).any(axis=1))
    if not len(used):
        return arms[:0]
    return np.asarray(arms[max(used[0] - 1, 0) : used[-1] + 2])


def _in_turn(sequences: Sequence[MovementSequence]) -> list[MovementSequence]:
    """Put the recordings in turns of all participants."""
    people: dict[str, list[MovementSequence]] = {}
    for one in sequences:
        people.setdefault(one.participant, []).append(one)
    return [one for one in chain.from_iterable(zip_longest(*people.values())) if one is not None]
