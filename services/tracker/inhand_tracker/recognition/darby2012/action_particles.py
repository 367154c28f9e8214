"""Particles over actions, part predictors and training poses (Darby et al. 2012, section 4).

They are drawn by the action dynamics from the particles before, or from the memberships that a
classifier gives the present body pose.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.special import ndtr

from inhand_tracker.body.skeleton import PARTS
from inhand_tracker.geometry.arrays import Array, Indices, Singles
from inhand_tracker.recognition.darby2012.parameters import DEFAULT_DARBY2012, Darby2012Parameters


@dataclass(frozen=True)
class ActionParticles:
    """P particles (a, l, n), each (P,): action, part, training frame; their weights sum to 1."""

    actions: Indices
    parts: Indices
    frames: Indices
    weights: Array


@dataclass(frozen=True)
class TrainingPoses:
    """Compares the body poses (N, 60) of one action with others, in single precision."""

    poses: Singles

    @cached_property
    def _squares(self) -> Singles:
        return np.square(self.poses).sum(axis=1)

    def distances(self, asked: Array) -> Singles:
        """Squared Euclidean distances (M, N) of poses (M, 60), less each pose's own square."""
        scaled = np.float32(2.0) * asked.astype(np.float32)
        return np.asarray(self._squares - scaled @ self.poses.T, np.float32)

    def nearest(self, pose: Array) -> int:
        """Find the frame nearest to a pose (60,)."""
        return int(np.argmin(self.distances(pose[None])[0]))

    def neighbours(self, asked: Array, ranks: Indices) -> Indices:
        """μ: find each pose's (M, 60) neighbour of a rank (M,), 0 the nearest; the last at most."""
        distances = self.distances(asked)
        ranks = np.minimum(ranks, distances.shape[1] - 1)
        return np.array(
            [np.argpartition(row, rank)[rank] for row, rank in zip(distances, ranks, strict=True)],
            np.int64,
        )

    def ranks(self, asked: Array, frame: int) -> Indices:
        """Ranks (M,) of a frame among the neighbours of each pose (M, 60)."""
        distances = self.distances(asked)
        return np.asarray((distances < distances[:, frame : frame + 1]).sum(axis=1))


def move_particles(
    particles: ActionParticles,
    count: int,
    actions: Sequence[TrainingPoses],
    random: np.random.Generator,
    parameters: Darby2012Parameters = DEFAULT_DARBY2012,
) -> ActionParticles:
    """Draw ``count`` action particles (section 4.2) from those before, by the action dynamics.

    The weights of the result are equal.
    """
    parents = random.choice(len(particles.weights), count, p=particles.weights)
    before = particles.actions[parents]
    after, parts = before.copy(), particles.parts[parents].copy()
    if len(actions) > 1:
        changing = random.random(count) >= parameters.stays
        others = random.integers(len(actions) - 1, size=count)
        after = np.where(changing, others + (others >= before), before)
        parts = np.where(changing, random.integers(len(PARTS), size=count), parts)
    ranks = np.rint(np.abs(random.normal(0.0, parameters.neighbour_sigma, count)))
    poses = training_poses(actions, before, particles.frames[parents])
    frames = np.empty(count, np.int64)
    for action in np.unique(after):
        ours = after == action
        frames[ours] = actions[action].neighbours(poses[ours], ranks[ours].astype(np.int64))
    return ActionParticles(after, parts, frames, np.full(count, 1.0 / max(count, 1)))


def likeliest_actions(memberships: Array, mass: float = DEFAULT_DARBY2012.top_mass) -> Array:
    """Keep the memberships (K,) of the likeliest actions that hold half of the mass; sum 1."""
    order = np.argsort(-memberships)
    held = np.cumsum(memberships[order])
    kept = order[: int(np.searchsorted(held, mass * held[-1])) + 1]
    shares = np.zeros_like(memberships)
    shares[kept] = memberships[kept]
    return shares / shares.sum()


def draw_particles(
    count: int,
    shares: Array,
    pose: Array,
    actions: Sequence[TrainingPoses],
    random: np.random.Generator,
) -> ActionParticles:
    """Draw importance particles (section 4.3), before any correction, or initialiser particles.

    Actions come by their shares (K,), with the frame nearest to the body pose (60,) and any part.
    """
    chosen = random.choice(len(shares), count, p=shares)
    nearest = np.zeros(len(shares), np.int64)
    for action in np.unique(chosen):
        nearest[action] = actions[action].nearest(pose)
    parts = random.integers(len(PARTS), size=count)
    return ActionParticles(chosen, parts, nearest[chosen], np.full(count, 1.0 / max(count, 1)))


def corrections(
    importance: ActionParticles,
    shares: Array,
    before: ActionParticles,
    actions: Sequence[TrainingPoses],
    parameters: Darby2012Parameters = DEFAULT_DARBY2012,
) -> Array:
    """Correct importance particles that were drawn by shares (K,): f / g (equation 1), (P,).

    f is the probability that the particles before lead to one by the action dynamics, g that it
    was drawn: the nearest frame is certain, every part as likely as another.
    """
    predicted = np.zeros((len(shares), len(PARTS)))
    changes = (1.0 - parameters.stays) / max(len(shares) - 1, 1)
    poses = training_poses(actions, before.actions, before.frames)
    for action in np.unique(importance.actions):
        frame = int(importance.frames[importance.actions == action][0])
        ranks = actions[action].ranks(poses, frame)
        led = before.weights * rank_chances(ranks, parameters.neighbour_sigma)
        same = before.actions == action
        np.add.at(predicted[action], before.parts[same], parameters.stays * led[same])
        predicted[action] += changes * led[~same].sum() / len(PARTS)
    proposed = shares[importance.actions] / len(PARTS)
    return predicted[importance.actions, importance.parts] / proposed


def rank_chances(ranks: Indices, sigma: float = DEFAULT_DARBY2012.neighbour_sigma) -> Array:
    """Probabilities of ranks φ = round |N(0, σ²)|."""
    upper = ndtr((ranks + 0.5) / sigma)
    lower = ndtr(np.maximum(ranks - 0.5, 0.0) / sigma)
    return np.asarray(2.0 * (upper - lower))


def training_poses(actions: Sequence[TrainingPoses], numbers: Indices, frames: Indices) -> Array:
    """Look up the training poses (P, 60) of frames (P,) of actions (P,)."""
    poses = np.empty((len(frames), actions[0].poses.shape[1]))
    for action in np.unique(numbers):
        ours = numbers == action
        poses[ours] = actions[action].poses[frames[ours]]
    return poses


def join_particles(sets: Sequence[ActionParticles], weights: Array) -> ActionParticles:
    """Join sets of particles to one, with these weights, which need not sum to 1."""
    return ActionParticles(
        np.concatenate([one.actions for one in sets]),
        np.concatenate([one.parts for one in sets]),
        np.concatenate([one.frames for one in sets]),
        weights / weights.sum(),
    )
