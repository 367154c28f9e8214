"""Kernel ridge regression on landmarks (the subset of regressors; Rasmussen and Williams 2006,
section 8.3.1), with the residuals of groups that were held out.

Time and memory grow with the number of samples N: all that is kept of them are sums of the size of
the landmarks.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from inhand_tracker.geometry.arrays import Array, Indices, Singles
from inhand_tracker.prior.kernels.distances import distances_of
from inhand_tracker.prior.parameters import DEFAULT_PRIOR_LEARNING, PriorLearningParameters

CHUNK = 8192
"""Number of samples that are summed up at once, to bound the memory."""


@dataclass(frozen=True)
class KernelRidge:
    """Predicts ``offset`` (M,) + k(x) @ ``coefficients`` (L, M), k the Gaussian kernel of squared
    width ``width`` to each of ``landmarks`` (L, D)."""

    landmarks: Singles
    width: float
    coefficients: Array
    offset: Array

    def kernel(self, inputs: Singles) -> Array:
        """The kernel (T, L) of inputs (T, D): 1 at a landmark, 0 far from it."""
        return gaussian(inputs, self.landmarks, self.width)

    def kernel_of(self, one: Singles) -> Array:
        """The kernel (L,) of one input (D,), many times faster than that of many."""
        return np.exp(distances_of(one, self.landmarks) / (-2.0 * self.width))

    def predict(self, inputs: Singles) -> Array:
        """(..., M) for inputs (..., D)."""
        return self.predict_by(self.kernel(inputs))

    def predict_by(self, kernel: Array) -> Array:
        """(..., M) for inputs by their kernel (..., L)."""
        return kernel @ self.coefficients + self.offset


def gaussian(inputs: Singles, landmarks: Singles, width: float) -> Array:
    """exp(−d²/(2 width)) of the distances d between inputs (T, D) and landmarks (L, D)."""
    return np.exp(squared_distances(inputs, landmarks) / (-2.0 * width))


def usual_width(
    landmarks: Singles, parameters: PriorLearningParameters = DEFAULT_PRIOR_LEARNING
) -> float:
    """Find the squared width of a kernel of landmarks (L, D), by their usual distance."""
    usual = float(np.median(squared_distances(landmarks, landmarks)))
    return max(usual, 1e-12) * parameters.kernel_width**2


def squared_distances(inputs: Singles, others: Singles) -> Array:
    """Squared distances (T, L), in double precision, so that those of nearly equal poses are not
    below 0."""
    one, other = inputs.astype(np.float64), others.astype(np.float64)
    products = one @ other.T
    sums = np.square(one).sum(axis=1)[:, None] + np.square(other).sum(axis=1)
    return np.maximum(sums - 2.0 * products, 0.0)


def fit(
    inputs: Singles,
    targets: Singles,
    groups: Indices,
    landmark_rows: Indices,
    parameters: PriorLearningParameters = DEFAULT_PRIOR_LEARNING,
) -> tuple[KernelRidge, Array]:
    """Learn from inputs (N, D) and targets (N, M); also the landmarks' held-out residuals (L, M).

    Of the ridges that is taken which leaves the least of these, the first where nothing is held
    out. Samples of one of ``groups`` (N,) are held out together: a landmark's residual, target less
    prediction, is that of a regression without any sample of its group. Needs the extra ``lab``.
    """
    from scipy.linalg import solve_triangular

    landmarks = inputs[landmark_rows]
    width = usual_width(landmarks, parameters)
    jitter = parameters.jitter * np.eye(len(landmarks))
    root = np.linalg.cholesky(gaussian(landmarks, landmarks, width) + jitter)
    offset = targets.mean(axis=0, dtype=np.float64)

    def features(rows: Indices) -> Array:
        kernel = gaussian(inputs[rows], landmarks, width)
        return np.asarray(solve_triangular(root, kernel.T, lower=True)).T

    names = np.unique(groups)
    sums = [_sums(features, targets, offset, np.flatnonzero(groups == name)) for name in names]
    scatter = np.sum([group for group, _ in sums], axis=0)
    cross = np.sum([group for _, group in sums], axis=0)
    residuals = np.empty((len(parameters.ridges), len(landmarks), targets.shape[1]))
    for name, (group_scatter, group_cross) in zip(names, sums, strict=True):
        held_out = np.flatnonzero(groups[landmark_rows] == name)
        rows = landmark_rows[held_out]
        away, described = targets[rows] - offset, features(rows)
        for tried, ridge in enumerate(parameters.ridges):
            weights = _solve(scatter - group_scatter, cross - group_cross, ridge)
            residuals[tried, held_out] = away - described @ weights
    best = int(np.square(residuals).sum(axis=(1, 2)).argmin())
    weights = _solve(scatter, cross, parameters.ridges[best])
    coefficients = solve_triangular(root.T, weights, lower=False)
    return KernelRidge(landmarks, width, np.asarray(coefficients), offset), residuals[best]


def _sums(
    features: Callable[[Indices], Array], targets: Singles, offset: Array, rows: Indices
) -> tuple[Array, Array]:
    """Σ φ φᵀ (L, L) and Σ φ yᵀ (L, M) over some samples."""
    pieces = _chunks(rows)
    first = features(pieces[0])
    scatter, cross = first.T @ first, first.T @ (targets[pieces[0]] - offset)
    for piece in pieces[1:]:
        more = features(piece)
        scatter += more.T @ more
        cross += more.T @ (targets[piece] - offset)
    return scatter, cross


def _chunks(rows: Indices) -> Sequence[Indices]:
    return [rows[start : start + CHUNK] for start in range(0, len(rows), CHUNK)]


def _solve(scatter: Array, cross: Array, ridge: float) -> Array:
    return np.asarray(np.linalg.solve(scatter + ridge * np.eye(len(scatter)), cross), np.float64)
