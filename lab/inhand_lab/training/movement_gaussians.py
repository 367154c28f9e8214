"""Fits classes of movements: a few Gaussians each, with one covariance for all."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from inhand_tracker.geometry.arrays import Array, Flags, Indices
from inhand_tracker.recognition.movement_classes import MovementClasses
from numpy.typing import NDArray
from scipy.cluster.vq import kmeans2
from scipy.linalg import eigh

SMALL = 1e-6
"""Spread of a feature, and share of the strongest direction, that counts as none."""
EMPTY_SIZE = 1e-3
"""Number of frames that a Gaussian without any is taken to have."""


@dataclass(frozen=True)
class MovementSequence:
    """Features (N, D) of frames of a recording at ``times_ns`` (N,), and all observations (M, 18)
    of its ``arms``.

    Actions count from 0; the number after the last is that of people who use nothing.
    """

    action: int
    participant: str
    features: Array
    times_ns: Indices
    arms: Array


@dataclass(frozen=True)
class MovementFrames:
    """All frames of all sequences: features (N, D), and of each its action, person, Gaussian."""

    features: Array
    actions: Indices
    people: NDArray[np.str_]
    gaussians: Indices

    def of(self, chosen: Flags) -> MovementFrames:
        return MovementFrames(
            self.features[chosen],
            self.actions[chosen],
            self.people[chosen],
            self.gaussians[chosen],
        )


def owners_of(actions: int, of_action: int, of_none: int) -> Indices:
    """Return the class (G,) of each Gaussian, by how many an action has, and nothing in use."""
    counts = [of_action] * actions + [of_none]
    return np.repeat(np.arange(actions + 1), counts)


def gathered(sequences: Sequence[MovementSequence]) -> MovementFrames:
    """Put all sequences together; no frame has a Gaussian yet."""
    features = [one.features for one in sequences]
    lengths = [len(some) for some in features]
    return MovementFrames(
        np.concatenate(features),
        np.repeat([one.action for one in sequences], lengths),
        np.repeat([one.participant for one in sequences], lengths),
        np.zeros(sum(lengths), np.int64),
    )


def clustered(frames: MovementFrames, owners: Indices, shrinkage: float) -> MovementFrames:
    """Give each frame a Gaussian of its class: k-means in the span of the classes' middles."""
    first = np.searchsorted(owners, frames.actions)
    classes = fit_gaussians(replace(frames, gaussians=first), owners, shrinkage)
    inside, _ = classes.project(frames.features)
    gaussians = first.copy()
    for number in range(owners[-1] + 1):
        ours = frames.actions == number
        count = int((owners == number).sum())
        random = np.random.default_rng(number)
        _, nearest = kmeans2(inside[ours], count, minit="++", rng=random)
        gaussians[ours] += nearest
    return replace(frames, gaussians=gaussians)


def fit_gaussians(frames: MovementFrames, owners: Indices, shrinkage: float) -> MovementClasses:
    """Fit Gaussians with one covariance; one without frames stands at its class's middle."""
    actions = int(owners[-1])
    means, spreads = frames.features.mean(axis=0), frames.features.std(axis=0) + SMALL
    scaled = (frames.features - means) / spreads
    centres, sizes = _centres(frames, scaled, owners)
    # What people do who use nothing is too wide to show how actions vary.
    of_actions = frames.actions < actions
    residuals = scaled[of_actions] - centres[frames.gaussians[of_actions]]
    whitening = _whitening(residuals, shrinkage)
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


def _centres(frames: MovementFrames, scaled: Array, owners: Indices) -> tuple[Array, Array]:
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
