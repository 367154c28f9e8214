"""Trains the recognition of movements: Gaussians, what each says, and what is strange.

All that must hold for unseen people is learned from people left out: each group of participants in
turn is judged by what the others teach.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from inhand_tracker.geometry.arrays import Array, Flags
from inhand_tracker.recognition.class_filter import ClassFilter
from inhand_tracker.recognition.movement_classes import MovementClasses
from inhand_tracker.recognition.parameters import DEFAULT_RECOGNITION
from numpy.typing import NDArray

from inhand_lab.training.arm_course_training import learn_courses
from inhand_lab.training.movement_gaussians import (
    MovementFrames,
    MovementSequence,
    clustered,
    fit_gaussians,
    gathered,
    owners_of,
)
from inhand_lab.training.parameters import DEFAULT_TRAINING, TrainingParameters

LEAST_PROBABILITY = 1e-9
"""Probability of the true action at the least, so that one frame cannot decide on a temper."""


@dataclass(frozen=True)
class _Fold:
    """Frames ``left_out`` (N,), and the classes that the other frames teach."""

    left_out: Flags
    classes: MovementClasses


def train_movements(
    sequences: Sequence[MovementSequence],
    actions: int,
    parameters: TrainingParameters = DEFAULT_TRAINING,
) -> tuple[MovementClasses, float]:
    """Learn classes of movements, and the temper: the share of each frame's evidence that is new.

    The sequences are of two participants at least, and of every action and of none. People unlike
    all others teach the arms' courses alone: nobody else shows how people like them vary.
    """
    arms = learn_courses(sequences, actions, parameters)
    frames, folds = _left_out(sequences, actions, parameters)
    if strangers := _strangers(folds, frames, parameters.within_limits_share):
        sequences = [one for one in sequences if one.participant not in strangers]
        frames, folds = _left_out(sequences, actions, parameters)
    says = _says(folds, frames, parameters.prior_frames)
    limits = _limits(folds, frames, parameters.within_limits_share)
    reaches = _reaches(folds, frames, parameters.within_reach_share)

    def judged(classes: MovementClasses) -> MovementClasses:
        return replace(classes, says=says, limits=limits, reaches=reaches)

    folds = [replace(fold, classes=judged(fold.classes)) for fold in folds]
    temper = _best_temper(folds, frames, sequences, parameters.tempers)
    classes = judged(fit_gaussians(frames, folds[0].classes.owners, parameters.shrinkage))
    return replace(classes, arms=arms), temper


def _left_out(
    sequences: Sequence[MovementSequence], actions: int, parameters: TrainingParameters
) -> tuple[MovementFrames, list[_Fold]]:
    """Return all frames, and what is learned where each group of participants is left out."""
    owners = owners_of(actions, parameters.action_gaussians, parameters.idle_gaussians)
    frames = clustered(gathered(sequences), owners, parameters.shrinkage)
    return frames, [
        _Fold(out, fit_gaussians(frames.of(~out), owners, parameters.shrinkage))
        for out in _groups(frames.people, parameters.groups)
    ]


def _strangers(folds: Sequence[_Fold], frames: MovementFrames, share: float) -> set[str]:
    """Name the participants whose bodies are unlike all others', as another sensor's are.

    Half of what they do is farther away than the limits of the middle participant, by as much as
    makes the arms speak. Nobody is a stranger where fewer than two others would be left to teach
    an action.
    """
    in_use = frames.actions < frames.actions.max()
    distances = np.empty((len(frames.people), 2))
    for fold in folds:
        distances[fold.left_out] = fold.classes.gaussians(frames.features[fold.left_out])[1]
    theirs = {
        name: distances[in_use & (frames.people == name)] for name in np.unique(frames.people)
    }
    theirs = {name: some for name, some in theirs.items() if len(some)}
    limits = np.median([np.quantile(some, share, axis=0) for some in theirs.values()], axis=0)
    strangers = {
        str(name)
        for name, some in theirs.items()
        if np.log(np.maximum(np.median(some, axis=0) / limits, 1.0)).sum()
        > DEFAULT_RECOGNITION.home_ends
    }
    left = ~np.isin(frames.people, list(strangers))
    teachers = [
        len(np.unique(frames.people[left & (frames.actions == action)]))
        for action in range(frames.actions.max())
    ]
    return strangers if min(teachers) >= 2 else set()


def _groups(people: NDArray[np.str_], most: int) -> Iterator[Flags]:
    """Yield the frames (N,) of each group of participants."""
    names = np.unique(people)
    count = min(most, len(names))
    for first in range(count):
        yield np.isin(people, names[first::count])


def _says(folds: Sequence[_Fold], frames: MovementFrames, prior_frames: float) -> Array:
    """Estimate P(class | Gaussian) over P(class), (G, K + 1), on people left out."""
    gaussians, classes = folds[0].classes.says.shape
    says = np.full((gaussians, classes), prior_frames)
    for fold in folds:
        shares, _ = fold.classes.gaussians(frames.features[fold.left_out])
        for number in range(classes):
            says[:, number] += shares[frames.actions[fold.left_out] == number].sum(axis=0)
    frequencies = np.bincount(frames.actions, minlength=classes) / len(frames.actions)
    return np.asarray(says / says.sum(axis=1, keepdims=True) / frequencies)


def _limits(folds: Sequence[_Fold], frames: MovementFrames, share: float) -> Array:
    """Return the two distances (2,) within which that share of the actions' frames is."""
    in_use = frames.actions < frames.actions.max()
    distances = [
        fold.classes.gaussians(frames.features[fold.left_out & in_use])[1] for fold in folds
    ]
    return np.quantile(np.concatenate(distances), share, axis=0)


def _reaches(folds: Sequence[_Fold], frames: MovementFrames, share: float) -> Array:
    """Return the distances (K,) within which that share of each action's own frames is."""
    reaches = []
    for action in range(frames.actions.max()):
        ours = frames.actions == action
        distances = [
            fold.classes.apart(frames.features[fold.left_out & ours])[:, action] for fold in folds
        ]
        reaches.append(np.quantile(np.concatenate(distances), share))
    return np.array(reaches)


def _best_temper(
    folds: Sequence[_Fold],
    frames: MovementFrames,
    sequences: Sequence[MovementSequence],
    tempers: Sequence[float],
) -> float:
    """Return the temper under which the true action's filtered probability is greatest (log)."""
    people = [set(frames.people[fold.left_out]) for fold in folds]
    judged = [
        (one, fold.classes.evidence(one.features))
        for fold, theirs in zip(folds, people, strict=True)
        for one in sequences
        if one.participant in theirs
    ]
    actions = folds[0].classes.actions
    scores = []
    for temper in tempers:
        chances = [
            chance
            for one, evidence in judged
            for chance in _true_chances(one, evidence, ClassFilter(actions, temper))
        ]
        scores.append(np.log(np.maximum(chances, LEAST_PROBABILITY)).mean())
    return tempers[int(np.argmax(scores))]


def _true_chances(one: MovementSequence, evidence: Array, running: ClassFilter) -> list[float]:
    """Filter the evidence (N, K + 1); return the probabilities (N,) of the true action."""
    return [
        running.step(int(time_ns), frame)[one.action]
        for time_ns, frame in zip(one.times_ns, evidence, strict=True)
    ]
