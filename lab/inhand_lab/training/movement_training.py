"""Trains the recognition of movements: Gaussians, what each says, and what is strange.

All that must hold for unseen people is learned from people left out: each group of participants in
turn is judged by what the others teach.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from inhand_tracker.geometry.arrays import Array, Flags, Indices
from inhand_tracker.recognition.class_filter import ClassFilter
from inhand_tracker.recognition.movement_classes import MovementClasses
from numpy.typing import NDArray
from scipy.cluster.vq import kmeans2
from scipy.linalg import eigh

GAUSSIANS = 3
"""To an action."""
BACKGROUND_GAUSSIANS = 60
"""To people who use nothing, who may do anything."""
KEPT = 0.98
"""The share of frames of people left out within the limits of strangeness."""
REACHED = 0.3
"""The share of frames of people left out within the reach of their own action."""
SHRINKAGE = 0.05
"""How far the covariance goes towards the identity of standardised features."""
GROUPS = 5
"""Of participants, at most, each left out once."""
PRIOR_COUNT = 1.0
"""Frames of every action that a Gaussian is taken to have seen beforehand."""
TEMPERS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.4)


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

    def of(self, chosen: Flags) -> "_Frames":
        return _Frames(
            self.features[chosen],
            self.actions[chosen],
            self.people[chosen],
            self.gaussians[chosen],
        )


def train_movements(
    sequences: Sequence[MovementSequence], actions: int
) -> tuple[MovementClasses, float]:
    """Classes of movements, and how much of each frame's evidence is new.

    The sequences are of two participants at least, and of every action and of none.
    """
    frames = _frames(sequences, actions)
    judges = [(out, _fit(frames.of(~out), actions)) for out in _left_out(frames.people)]
    classes = actions + 1
    says = np.full((len(_owners(actions)), classes), PRIOR_COUNT)
    for out, judge in judges:
        shares, _ = judge.gaussians(frames.features[out])
        for number in range(classes):
            says[:, number] += shares[frames.actions[out] == number].sum(axis=0)
    frequencies = np.bincount(frames.actions, minlength=classes) / len(frames.actions)
    learned = {
        "says": says / says.sum(axis=1, keepdims=True) / frequencies,
        "limits": _limits(judges, frames),
        "reaches": _reaches(judges, frames, actions),
    }
    people = [set(frames.people[out]) for out, _ in judges]
    temper = _best_temper(
        [
            (one, replace(judge, **learned))
            for (_, judge), theirs in zip(judges, people, strict=True)
            for one in sequences
            if one.participant in theirs
        ],
        actions,
    )
    return replace(_fit(frames, actions), **learned), temper


def _owners(actions: int) -> Indices:
    """The class (G,) of each Gaussian."""
    counts = [GAUSSIANS] * actions + [BACKGROUND_GAUSSIANS]
    return np.repeat(np.arange(actions + 1), counts)


def _frames(sequences: Sequence[MovementSequence], actions: int) -> _Frames:
    lengths = [len(one.features) for one in sequences]
    features = np.concatenate([one.features for one in sequences])
    labels = np.repeat([one.action for one in sequences], lengths)
    people = np.repeat([one.participant for one in sequences], lengths)
    owners = _owners(actions)
    gaussians = np.searchsorted(owners, labels)
    inside, _ = _fit(_Frames(features, labels, people, gaussians), actions).project(features)
    for number in range(actions + 1):
        ours = labels == number
        count = int((owners == number).sum())
        _, nearest = kmeans2(inside[ours], count, minit="++", rng=np.random.default_rng(number))
        gaussians[ours] += nearest
    return _Frames(features, labels, people, gaussians)


def _fit(frames: _Frames, actions: int) -> MovementClasses:
    """Gaussians with one covariance; one without frames stands where its class's middle is."""
    owners = _owners(actions)
    means, spreads = frames.features.mean(axis=0), frames.features.std(axis=0) + 1e-6
    scaled = (frames.features - means) / spreads
    centres = np.zeros((len(owners), scaled.shape[1]))
    sizes = np.full(len(owners), 1e-3)
    residuals = np.empty_like(scaled)
    for gaussian, owner in enumerate(owners):
        ours = frames.gaussians == gaussian
        centres[gaussian] = scaled[ours if ours.any() else frames.actions == owner].mean(axis=0)
        sizes[gaussian] += ours.sum()
        residuals[ours] = scaled[ours] - centres[gaussian]
    # What people do who use nothing is too wide to tell how actions vary.
    residuals = residuals[frames.actions < actions]
    covariance = residuals.T @ residuals / len(residuals)
    width = len(covariance)
    level = np.trace(covariance) / width
    values, axes = eigh((1.0 - SHRINKAGE) * covariance + SHRINKAGE * level * np.eye(width))
    whitening = axes / np.sqrt(values)
    white = centres @ whitening
    _, strength, directions = np.linalg.svd(white - white.mean(axis=0), full_matrices=False)
    directions = directions[strength > 1e-6 * strength[0]].T
    return MovementClasses(
        means,
        whitening / spreads[:, None],
        directions,
        white @ directions,
        np.log(sizes / sizes.sum()),
        np.full((len(owners), actions + 1), 1.0),
        np.full(2, np.inf),
        np.full(actions, np.inf),
        owners,
    )


def _left_out(people: NDArray[np.str_]) -> Iterator[Flags]:
    names = np.unique(people)
    count = min(GROUPS, len(names))
    for first in range(count):
        yield np.isin(people, names[first::count])


def _limits(judges: Sequence[tuple[Flags, MovementClasses]], frames: _Frames) -> Array:
    last = frames.actions.max()
    known = [
        judge.gaussians(frames.features[out & (frames.actions < last)])[1] for out, judge in judges
    ]
    return np.quantile(np.concatenate(known), KEPT, axis=0)


def _reaches(
    judges: Sequence[tuple[Flags, MovementClasses]], frames: _Frames, actions: int
) -> Array:
    reaches = []
    for action in range(actions):
        apart = []
        for out, judge in judges:
            theirs = frames.features[out & (frames.actions == action)]
            apart.append(judge.apart(theirs)[:, action])
        reaches.append(np.quantile(np.concatenate(apart), REACHED))
    return np.array(reaches)


def _best_temper(judged: Sequence[tuple[MovementSequence, MovementClasses]], actions: int) -> float:
    """That under which the filtered probability of the true action is greatest (its log)."""
    evidence = [classes.evidence(one.features) for one, classes in judged]
    scores = []
    for temper in TEMPERS:
        chances = []
        for (one, _), told in zip(judged, evidence, strict=True):
            running = ClassFilter(actions, temper)
            chances += [
                running.step(int(time_ns), frame)[one.action]
                for time_ns, frame in zip(one.times_ns, told, strict=True)
            ]
        scores.append(np.log(np.maximum(chances, 1e-9)).mean())
    return TEMPERS[int(np.argmax(scores))]
