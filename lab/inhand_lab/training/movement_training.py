"""Trains the recognition of movements: Gaussians, what each says, and what is strange.

All that must hold for unseen people is learned from people left out: each group of participants in
turn is judged by what the others teach.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from inhand_tracker.geometry.arrays import Array, Flags, Indices
from inhand_tracker.recognition.class_filter import ClassFilter
from inhand_tracker.recognition.movement_classes import MovementClasses
from numpy.typing import NDArray
from scipy.cluster.vq import kmeans2
from scipy.linalg import eigh

from inhand_lab.training.parameters import DEFAULT_TRAINING, TrainingParameters

SMALL = 1e-6
"""Spread of a feature, and share of the strongest direction, that counts as none."""
EMPTY_SIZE = 1e-3
"""Number of frames that a Gaussian without any is taken to have."""
LEAST_PROBABILITY = 1e-9
"""Probability of the true action at the least, so that one frame cannot decide on a temper."""


@dataclass(frozen=True)
class MovementSequence:
    """Features (N, D) of frames of a recording at ``times_ns`` (N,).

    Actions count from 0; the number after the last is that of people who use nothing.
    """

    action: int
    participant: str
    features: Array
    times_ns: Indices


@dataclass(frozen=True)
class _Frames:
    """All frames of all sequences: features (N, D), and of each its action, person, Gaussian."""

    features: Array
    actions: Indices
    people: NDArray[np.str_]
    gaussians: Indices

    def of(self, chosen: Flags) -> _Frames:
        return _Frames(
            self.features[chosen],
            self.actions[chosen],
            self.people[chosen],
            self.gaussians[chosen],
        )


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

    The sequences are of two participants at least, and of every action and of none.
    """
    owners = _owners(actions, parameters)
    frames = _clustered(_gathered(sequences), owners, parameters)
    folds = [
        _Fold(out, _fit(frames.of(~out), owners, parameters))
        for out in _groups(frames.people, parameters.groups)
    ]
    says = _says(folds, frames, parameters.prior_frames)
    limits = _limits(folds, frames, parameters.within_limits_share)
    reaches = _reaches(folds, frames, parameters.within_reach_share)

    def judged(classes: MovementClasses) -> MovementClasses:
        return replace(classes, says=says, limits=limits, reaches=reaches)

    folds = [replace(fold, classes=judged(fold.classes)) for fold in folds]
    temper = _best_temper(folds, frames, sequences, parameters.tempers)
    return judged(_fit(frames, owners, parameters)), temper


def _owners(actions: int, parameters: TrainingParameters) -> Indices:
    """Return the class (G,) of each Gaussian."""
    counts = [parameters.action_gaussians] * actions + [parameters.idle_gaussians]
    return np.repeat(np.arange(actions + 1), counts)


def _gathered(sequences: Sequence[MovementSequence]) -> _Frames:
    """Put all sequences together; no frame has a Gaussian yet."""
    lengths = [len(one.features) for one in sequences]
    return _Frames(
        np.concatenate([one.features for one in sequences]),
        np.repeat([one.action for one in sequences], lengths),
        np.repeat([one.participant for one in sequences], lengths),
        np.zeros(sum(lengths), np.int64),
    )


def _clustered(frames: _Frames, owners: Indices, parameters: TrainingParameters) -> _Frames:
    """Give each frame a Gaussian of its class: k-means in the span of the classes' middles."""
    first = np.searchsorted(owners, frames.actions)
    classes = _fit(replace(frames, gaussians=first), owners, parameters)
    inside, _ = classes.project(frames.features)
    gaussians = first.copy()
    for number in range(owners[-1] + 1):
        ours = frames.actions == number
        count = int((owners == number).sum())
        random = np.random.default_rng(number)
        _, nearest = kmeans2(inside[ours], count, minit="++", rng=random)
        gaussians[ours] += nearest
    return replace(frames, gaussians=gaussians)


def _fit(frames: _Frames, owners: Indices, parameters: TrainingParameters) -> MovementClasses:
    """Fit Gaussians with one covariance; one without frames stands at its class's middle."""
    actions = int(owners[-1])
    means, spreads = frames.features.mean(axis=0), frames.features.std(axis=0) + SMALL
    scaled = (frames.features - means) / spreads
    centres, sizes = _centres(frames, scaled, owners)
    # What people do who use nothing is too wide to show how actions vary.
    of_actions = frames.actions < actions
    residuals = scaled[of_actions] - centres[frames.gaussians[of_actions]]
    whitening = _whitening(residuals, parameters.shrinkage)
    white = centres @ whitening
    _, strength, directions = np.linalg.svd(white - white.mean(axis=0), full_matrices=False)
    directions = directions[strength > SMALL * strength[0]].T
    return MovementClasses(
        means=means,
        whitening=whitening / spreads[:, None],
        directions=directions,
        centres=white @ directions,
        log_shares=np.log(sizes / sizes.sum()),
        says=np.full((len(owners), actions + 1), 1.0),
        limits=np.full(2, np.inf),
        reaches=np.full(actions, np.inf),
        owners=owners,
    )


def _centres(frames: _Frames, scaled: Array, owners: Indices) -> tuple[Array, Array]:
    """Return the middles (G, D) and the sizes (G,) of the Gaussians in scaled features (N, D)."""
    centres = np.zeros((len(owners), scaled.shape[1]))
    sizes = np.full(len(owners), EMPTY_SIZE)
    for gaussian, owner in enumerate(owners):
        ours = frames.gaussians == gaussian
        centres[gaussian] = scaled[ours if ours.any() else frames.actions == owner].mean(axis=0)
        sizes[gaussian] += ours.sum()
    return centres, sizes


def _whitening(residuals: Array, shrinkage: float) -> Array:
    """Return the (D, D) that makes the shrunk covariance of residuals (N, D) the identity."""
    covariance = residuals.T @ residuals / len(residuals)
    width = len(covariance)
    level = np.trace(covariance) / width
    values, axes = eigh((1.0 - shrinkage) * covariance + shrinkage * level * np.eye(width))
    return np.asarray(axes / np.sqrt(values))


def _groups(people: NDArray[np.str_], most: int) -> Iterator[Flags]:
    """Yield the frames (N,) of each group of participants."""
    names = np.unique(people)
    count = min(most, len(names))
    for first in range(count):
        yield np.isin(people, names[first::count])


def _says(folds: Sequence[_Fold], frames: _Frames, prior_frames: float) -> Array:
    """Estimate P(class | Gaussian) over P(class), (G, K + 1), on people left out."""
    gaussians, classes = folds[0].classes.says.shape
    says = np.full((gaussians, classes), prior_frames)
    for fold in folds:
        shares, _ = fold.classes.gaussians(frames.features[fold.left_out])
        for number in range(classes):
            says[:, number] += shares[frames.actions[fold.left_out] == number].sum(axis=0)
    frequencies = np.bincount(frames.actions, minlength=classes) / len(frames.actions)
    return np.asarray(says / says.sum(axis=1, keepdims=True) / frequencies)


def _limits(folds: Sequence[_Fold], frames: _Frames, share: float) -> Array:
    """Return the two distances (2,) within which that share of the actions' frames is."""
    in_use = frames.actions < frames.actions.max()
    distances = [
        fold.classes.gaussians(frames.features[fold.left_out & in_use])[1] for fold in folds
    ]
    return np.quantile(np.concatenate(distances), share, axis=0)


def _reaches(folds: Sequence[_Fold], frames: _Frames, share: float) -> Array:
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
    frames: _Frames,
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
