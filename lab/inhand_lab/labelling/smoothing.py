"""The likeliest way of an object through the frames of a stretch, by images and by how things move.

Each frame's image is a normal distribution about its pose. Things seldom leave the way between
keyframes, and do so smoothly; where they do not, they may do so much (Cauchy's distribution).
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from scipy.linalg import cho_solve_banded, cholesky_banded

from inhand_lab.labelling.parameters import LabellingParameters

_BAND = 18
"""Number of diagonals of the information: three frames of six dimensions hang together."""


@dataclass(frozen=True)
class Way:
    """Poses (T, 3), (T, 4) of T frames at ``times_s`` (T,)."""

    translations: Array
    rotations: Array
    times_s: Array

    def moved(self, steps: Array) -> "Way":
        """Move every pose by its step (T, 6)."""
        turns = rotations.multiply(rotations.from_vector(steps[:, 3:]), self.rotations)
        return Way(self.translations + steps[:, :3], turns, self.times_s)

    def deviations(self, other: "Way") -> Array:
        """Return the deviations (T, 6) of the other way from this one."""
        turns = rotations.multiply(other.rotations, rotations.conjugate(self.rotations))
        return np.hstack((other.translations - self.translations, rotations.to_vector(turns)))


@dataclass(frozen=True)
class Smoothed:
    """The likeliest ``way``, and the covariance (T, 6, 6) of each of its poses."""

    way: Way
    covariances: Array


@dataclass(frozen=True)
class _Term:
    """R rows: ``factors`` (R, K) times the steps of the frames row … row + K - 1, added to what is
    ``left`` (R, 6), should be nothing, within ``scale``, (6,) or (R, 6)."""

    factors: Array
    left: Array
    scale: Array

    def weights(self) -> Array:
        """Weigh rows (R, 6): large residuals less, translations and rotations apart."""
        squares = (self.left / self.scale) ** 2
        halves = squares.reshape(len(squares), 2, 3).mean(axis=2)
        return np.repeat(1.0 / (1.0 + halves), 3, axis=1) / self.scale**2


def smooth(start: Way, guide: Way, information: Array, parameters: LabellingParameters) -> Smoothed:
    """Find the likeliest way of three or more frames near ``start``, of whose poses there is
    ``information`` (T, 6, 6), by the ``guide`` between keyframes."""
    way = start
    for _ in range(parameters.smoothing_steps):
        terms = list(_terms(way, guide, parameters))
        passed = start.deviations(way)
        pulled = -np.einsum("tij,tj->ti", information, passed)
        banded, wanted = _normal(information, pulled, terms)
        root = cholesky_banded(banded, lower=True), True
        way = way.moved(cho_solve_banded(root, wanted.ravel()).reshape(-1, 6))
    return Smoothed(way, _covariances(root, len(wanted)))


def _terms(way: Way, guide: Way, parameters: LabellingParameters) -> Iterator[_Term]:
    """Yield that the object keeps its velocity beside the guide, and its place there."""
    seconds = np.diff(way.times_s)[:, None]
    rate = 1.0 / seconds
    aside = guide.deviations(way)
    spread = np.repeat([parameters.acceleration_m, parameters.acceleration_rad], 3) / np.sqrt(3.0)
    spread[2] *= parameters.sight_share
    yield _Term(
        np.hstack((rate[:-1], -rate[:-1] - rate[1:], rate[1:])),
        np.diff(np.diff(aside, axis=0) * rate, axis=0),
        0.5 * (seconds[:-1] + seconds[1:]) * spread,
    )
    ones = np.ones_like(seconds)
    drift = np.repeat([parameters.smooth_drift_m, parameters.smooth_drift_rad], 3) / np.sqrt(3.0)
    drift[2] *= parameters.sight_share
    yield _Term(np.hstack((-ones, ones)), np.diff(aside, axis=0), np.sqrt(seconds) * drift)


def _normal(information: Array, pulled: Array, terms: list[_Term]) -> tuple[Array, Array]:
    """Add up the normal equations: the lower band (18, 6 T) of the matrix, and the right (T, 6)."""
    count = len(information)
    banded, wanted = np.zeros((_BAND, 6 * count)), pulled.copy()
    for row in range(6):
        for column in range(row + 1):
            banded[row - column, column::6] += information[:, row, column]
    for term in terms:
        weights, rows = term.weights(), len(term.left)
        for one in range(term.factors.shape[1]):
            factor = weights * term.factors[:, one, None]
            wanted[one : one + rows] -= factor * term.left
            for other in range(one + 1):
                block = factor * term.factors[:, other, None]
                for axis in range(6):
                    start = 6 * other + axis
                    diagonal = banded[6 * (one - other)]
                    diagonal[start : start + 6 * rows : 6] += block[:, axis]
    return banded, wanted


def _covariances(root: tuple[Array, bool], count: int) -> Array:
    """Return the blocks (T, 6, 6) on the diagonal of the inverse."""
    blocks = np.empty((count, 6, 6))
    for frame in range(count):
        here = slice(6 * frame, 6 * frame + 6)
        unit = np.zeros((6 * count, 6))
        unit[here] = np.eye(6)
        blocks[frame] = cho_solve_banded(root, unit)[here]
    return 0.5 * (blocks + np.swapaxes(blocks, 1, 2))
