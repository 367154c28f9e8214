"""Normal distributions over poses, and mixtures of them.

A pose is that of the object's centre: ``centre`` (3,) and ``rotation`` (4,) in the camera frame.
Deviations are (translation of the centre, rotation vector on the left), in metres and radians.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.kernels import pose_normals as kernels
from inhand_tracker.geometry.weights import normalised_weights

SIX = np.zeros(6)
"""It tells kernels how long a deviation is."""


@dataclass(frozen=True)
class PoseGaussian:
    """A normal distribution over poses: a mean pose, and the ``covariance`` (6, 6) about it."""

    centre: Array
    rotation: Array
    covariance: Array

    @cached_property
    def root(self) -> Array:
        """The triangular root (6, 6) of the covariance; raises LinAlgError if it has none."""
        return roots_of(self.covariance)

    def deviations(self, centres: Array, orientations: Array) -> Array:
        """Deviations (..., 6) of poses (..., 3) and (..., 4) from the mean."""
        return kernels.deviations(self.centre, self.rotation, centres, orientations, SIX)

    def square_distance(self, other: "PoseGaussian") -> float:
        """Squared Mahalanobis distance of another one's mean, by this covariance."""
        mean = self.centre, self.rotation, self.root
        return float(kernels.square_distances(*mean, other.centre, other.rotation))


@dataclass(frozen=True)
class PoseMixture:
    """A mixture of normal distributions over poses; its ``weights`` (K,) sum to 1. Of its parts
    those that are ``carried``, by their indices, go on from what was believed a moment before."""

    parts: tuple[PoseGaussian, ...]
    weights: Array
    carried: tuple[int, ...] = ()

    @cached_property
    def means(self) -> tuple[Array, Array]:
        """The parts' centres (K, 3) and rotations (K, 4)."""
        return means_of(self.parts)

    @cached_property
    def roots(self) -> Array:
        """The triangular roots (K, 6, 6) of the parts' covariances."""
        return roots_of(np.array([part.covariance for part in self.parts]))

    def with_carried(self, least: float) -> "PoseMixture":
        """Return the mixture in which the parts that are carried weigh ``least`` together, at the
        least; each gets an equal share of what they lack."""
        carried = list(self.carried)
        weight = float(self.weights[carried].sum())
        if not carried or weight >= least:
            return self
        weights = (1.0 - least) / (1.0 - weight) * self.weights
        weights[carried] = self.weights[carried] + (least - weight) / len(carried)
        return replace(self, weights=weights)

    def sample(self, count: int, random: np.random.Generator) -> tuple[Array, Array]:
        """Draw ``count`` poses (P, 3) and (P, 4), of each part in proportion to its weight."""
        ends = np.rint(np.cumsum(self.weights) * count).astype(int)
        parts = np.repeat(np.arange(len(ends)), np.diff(ends, prepend=0))
        normals = random.standard_normal((len(parts), 6))
        poses: tuple[Array, Array] = kernels.draw(parts, *self.means, self.roots, normals)
        return poses

    def log_densities(self, centres: Array, orientations: Array) -> Array:
        """Log densities (K, P) of poses, of each part times its weight."""
        densities: Array = kernels.log_densities(
            self.weights, *self.means, self.roots, centres, orientations
        )
        return densities

    def log_density(self, centres: Array, orientations: Array) -> Array:
        """Log density (P,) of poses (P, 3) and (P, 4)."""
        return np.logaddexp.reduce(self.log_densities(centres, orientations), axis=0)

    def moments(self) -> PoseGaussian:
        """Give the normal distribution of the same mean and covariance."""
        centres, turns = self.means
        mean = PoseGaussian(
            self.weights @ centres, rotations.mean(turns, self.weights), np.zeros((6, 6))
        )
        apart = mean.deviations(centres, turns)
        within = np.array([part.covariance for part in self.parts])
        covariance = (self.weights[:, None] * apart).T @ apart
        covariance += (self.weights @ within.reshape(-1, 36)).reshape(6, 6)
        return PoseGaussian(mean.centre, mean.rotation, covariance)


def draw_about(
    means: tuple[Array, Array], roots: Array, random: np.random.Generator
) -> tuple[Array, Array]:
    """Draw a pose about each of the ``means`` (P, 3) and (P, 4), by triangular roots (P, 6, 6) of
    covariances."""
    normals = random.standard_normal((len(roots), 6))
    poses: tuple[Array, Array] = kernels.draw(np.arange(len(roots)), *means, roots, normals)
    return poses


def roots_of(covariances: Array) -> Array:
    """Find the triangular roots (..., 6, 6) of covariances; raises LinAlgError where one has
    none, as it is not positive definite."""
    roots: Array = kernels.roots(covariances)
    if np.isnan(roots[..., 0, 0]).any():
        raise np.linalg.LinAlgError("a covariance of poses is not positive definite")
    return roots


def turn_blocks(matrices: Array, turns: Array) -> Array:
    """Rotate deviations of the pose by turns (..., 3, 3): T M Tᵀ of matrices (..., 6, 6)."""
    return kernels.turn_blocks(matrices, turns)


def mixture(parts: Sequence[PoseGaussian], log_weights: Array) -> PoseMixture:
    """Make a mixture by log-weights (K,) that are known up to a constant."""
    return PoseMixture(tuple(parts), normalised_weights(log_weights))


def means_of(parts: Sequence[PoseGaussian]) -> tuple[Array, Array]:
    """Return the centres (K, 3) and rotations (K, 4) of distributions."""
    centres = np.array([part.centre for part in parts])
    return centres, np.array([part.rotation for part in parts])


def moved_information(information: Array, arms: Array) -> Array:
    """Take the information (..., 6, 6) of a point at ``arms`` (..., 3) to where the
    pose is: Lᵀ I L, where L takes deviations of a pose to those of a point that moves along."""
    return kernels.moved_information(information, arms)


def moved_covariance(covariance: Array, arms: Array) -> Array:
    """Take the covariance (..., 6, 6) of a pose to that of a point at ``arms`` (..., 3) from where
    it is of: L C Lᵀ, L as in ``moved_information``."""
    moved: Array = kernels.moved_covariance(covariance, arms)
    return moved
