"""Trains the recognition of movements: Gaussians, what each says, and what is strange.

All that must hold for unseen people is learned from people left out: each group of participants in
turn is judged by what the others teach.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from inhand_tracker.class_filter import ClassFilter
from inhand_tracker.movement_classes import MovementClasses, strangeness_inputs
from numpy.typing import NDArray
from scipy.cluster.vq import kmeans2
from scipy.linalg import eigh
from sklearn.linear_model import LogisticRegression

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Flags = NDArray[np.bool_]

GAUSSIANS = 3
"""To an action."""
SHRINKAGE = 0.05
"""How far the covariance goes towards the identity of standardised features."""
GROUPS = 5
"""Of participants, at most, each left out once."""
PRIOR_COUNT = 1.0
"""Frames of every action that a Gaussian is taken to have seen beforehand."""
TEMPERS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.4)


@dataclass(frozen=True)
class MovementSequence:
    """Features (N, D) of frames of a recording at ``times_ns`` (N,); actions count from 0."""

    action: int
    participant: str
    features: Array
    times_ns: NDArray[np.int64]


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

    The sequences are of two participants at least, and of every action.
    """
    frames = _frames(sequences, actions)
    judges = [(out, _fit(frames.of(~out), actions)) for out in _left_out(frames.people)]
    says = np.full((actions * GAUSSIANS, actions), PRIOR_COUNT)
    for out, judge in judges:
        shares, _ = judge.gaussians(frames.features[out])
        for action in range(actions):
            says[:, action] += shares[frames.actions[out] == action].sum(axis=0)
    learned = {
        "says": says / says.sum(axis=1, keepdims=True),
        "strangeness": _strangeness([_distances(judge, frames.of(out)) for out, judge in judges]),
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


def _frames(sequences: Sequence[MovementSequence], actions: int) -> _Frames:
    lengths = [len(one.features) for one in sequences]
    features = np.concatenate([one.features for one in sequences])
    labels = np.repeat([one.action for one in sequences], lengths)
    people = np.repeat([one.participant for one in sequences], lengths)
    first = _fit(_Frames(features, labels, people, GAUSSIANS * labels), actions)
    inside, _ = first.project(features)
    gaussians = GAUSSIANS * labels
    for action in range(actions):
        ours = labels == action
        _, nearest = kmeans2(inside[ours], GAUSSIANS, minit="++", rng=np.random.default_rng(action))
        gaussians[ours] += nearest
    return _Frames(features, labels, people, gaussians)


def _fit(frames: _Frames, actions: int) -> MovementClasses:
    """Gaussians with one covariance; one without frames stands where its action's middle is."""
    count = actions * GAUSSIANS
    means, spreads = frames.features.mean(axis=0), frames.features.std(axis=0) + 1e-6
    scaled = (frames.features - means) / spreads
    centres = np.zeros((count, scaled.shape[1]))
    sizes = np.full(count, 1e-3)
    residuals = np.empty_like(scaled)
    for gaussian in range(count):
        ours = frames.gaussians == gaussian
        same_action = frames.actions == gaussian // GAUSSIANS
        centres[gaussian] = scaled[ours if ours.any() else same_action].mean(axis=0)
        sizes[gaussian] += ours.sum()
        residuals[ours] = scaled[ours] - centres[gaussian]
    covariance = residuals.T @ residuals / len(residuals)
    width = len(covariance)
    level = np.trace(covariance) / width
    shrunk = (1.0 - SHRINKAGE) * covariance + SHRINKAGE * level * np.eye(width)
    values, axes = eigh(shrunk)
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
        np.full((count, actions), 1.0 / actions),
        np.zeros(3),
    )


def _left_out(people: NDArray[np.str_]) -> Iterator[Flags]:
    names = np.unique(people)
    for first in range(min(GROUPS, len(names))):
        yield np.isin(people, names[first::GROUPS])


def _distances(judge: MovementClasses, frames: _Frames) -> tuple[Array, Array]:
    """Both distances of frames, (N, 2), as they are and as if their actions were not trained."""
    _, known = judge.gaussians(frames.features)
    strange = known.copy()
    owners = np.arange(len(judge.centres)) // GAUSSIANS
    for action in np.unique(frames.actions):
        ours = frames.actions == action
        others = owners != action
        without = replace(judge, centres=judge.centres[others], log_shares=judge.log_shares[others])
        strange[ours] = without.gaussians(frames.features[ours])[1]
    return known, strange


def _strangeness(distances: Sequence[tuple[Array, Array]]) -> Array:
    known, strange = (np.concatenate(ones) for ones in zip(*distances, strict=True))
    inputs = strangeness_inputs(np.concatenate((known, strange)))
    labels = np.repeat([0, 1], [len(known), len(strange)])
    model = LogisticRegression(fit_intercept=False, C=1e3, max_iter=1000).fit(inputs, labels)
    return np.asarray(model.coef_[0], float)


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
