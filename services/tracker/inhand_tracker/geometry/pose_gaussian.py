"""Normal distributions over poses, and mixtures of them.

A pose is that of the object's centre: ``centre`` (3,) and ``rotation`` (4,) in the camera frame.
Deviations are (translation of the centre, rotation vector on the left), in metres and radians.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.weights import normalised_weights


@dataclass(frozen=True)
class PoseGaussian:
    """A normal distribution over poses: a mean pose, and the ``covariance`` (6, 6) about it."""

    centre: Array
    rotation: Array
    covariance: Array

    def deviations(self, centres: Array, orientations: Array) -> Array:
        """Deviations (P, 6) of poses (P, 3) and (P, 4) from the mean."""
        turns = rotations.multiply(orientations, rotations.conjugate(self.rotation))
        return np.concatenate((centres - self.centre, rotations.to_vector(turns)), axis=1)

    def deviated(self, deviations: Array) -> tuple[Array, Array]:
        """Give the poses (P, 3) and (P, 4) with deviations (P, 6) from the mean."""
        turns = rotations.from_vector(deviations[:, 3:])
        return self.centre + deviations[:, :3], rotations.multiply(turns, self.rotation)

    def square_distance(self, other: "PoseGaussian") -> float:
        """Squared Mahalanobis distance of another one's mean, by this covariance."""
        off = self.deviations(other.centre[None], other.rotation[None])[0]
        return float(off @ np.linalg.solve(self.covariance, off))

    def sample(self, count: int, random: np.random.Generator) -> tuple[Array, Array]:
        """Draw ``count`` poses (P, 3) and (P, 4)."""
        root = np.linalg.cholesky(self.covariance)
        return self.deviated(random.normal(size=(count, 6)) @ root.T)

    def log_density(self, centres: Array, orientations: Array) -> Array:
        """Log density (P,) of poses (P, 3) and (P, 4)."""
        root = np.linalg.cholesky(self.covariance)
        whitened = np.linalg.solve(root, self.deviations(centres, orientations).T)
        scale = np.log(np.diag(root)).sum() + 3.0 * np.log(2.0 * np.pi)
        return np.asarray(-0.5 * np.square(whitened).sum(axis=0) - scale)


@dataclass(frozen=True)
class PoseMixture:
    """A mixture of normal distributions over poses; its ``weights`` (K,) sum to 1."""

    parts: tuple[PoseGaussian, ...]
    weights: Array

    def sample(self, count: int, random: np.random.Generator) -> tuple[Array, Array]:
        """Draw ``count`` poses (P, 3) and (P, 4), of each part in proportion to its weight."""
        ends = np.rint(np.cumsum(self.weights) * count).astype(int)
        counts = np.diff(ends, prepend=0)
        drawn = [p.sample(n, random) for p, n in zip(self.parts, counts, strict=True) if n]
        centres, orientations = zip(*drawn, strict=True)
        return np.concatenate(centres), np.concatenate(orientations)

    def log_densities(self, centres: Array, orientations: Array) -> Array:
        """Log densities (K, P) of poses, of each part times its weight."""
        logs = [part.log_density(centres, orientations) for part in self.parts]
        with np.errstate(divide="ignore"):
            return np.array(logs) + np.log(self.weights)[:, None]

    def moments(self) -> PoseGaussian:
        """Give the normal distribution of the same mean and covariance."""
        centres = np.array([part.centre for part in self.parts])
        turns = np.array([part.rotation for part in self.parts])
        mean = PoseGaussian(
            self.weights @ centres, rotations.mean(turns, self.weights), np.zeros((6, 6))
        )
        apart = mean.deviations(centres, turns)
        within = np.array([part.covariance for part in self.parts])
        covariance = np.einsum("k,ki,kj->ij", self.weights, apart, apart)
        covariance += np.einsum("k,kij->ij", self.weights, within)
        return PoseGaussian(mean.centre, mean.rotation, covariance)


def mixture(parts: Sequence[PoseGaussian], log_weights: Array) -> PoseMixture:
    """Make a mixture by log-weights (K,) that are known up to a constant."""
    return PoseMixture(tuple(parts), normalised_weights(log_weights))


def lever(arm: Array) -> Array:
    """Give the matrix (6, 6) that takes deviations of a pose to those of a point that moves along.

    ``arm`` (3,) is the way from the pose's centre to the point.
    """
    x, y, z = arm
    moved = np.eye(6)
    moved[:3, 3:] = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]
    return moved
