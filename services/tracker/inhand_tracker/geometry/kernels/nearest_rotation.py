"""The rotation nearest to a matrix, and the principal vector of a small symmetric matrix."""

import numpy as np
from inhand_runtime.compiled import njit

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.kernels.quaternions import quaternion_in, set_matrix

SWEEPS = 30
"""Number of sweeps of Jacobi's method, at the most; it takes half a dozen."""


@njit(cache=True, nogil=True)
def principal_vector(symmetric: Array) -> Array:
    """Return the eigenvector (N,) of the greatest eigenvalue, by Jacobi's method.

    The matrix (N, N) is diagonalised in place; NaN gives NaN.
    """
    size = len(symmetric)
    vectors = np.eye(size)
    for _ in range(SWEEPS):
        off, scale = 0.0, 0.0
        for row in range(size):
            scale += abs(symmetric[row, row])
            for column in range(row):
                off += abs(symmetric[row, column])
        if not off > 1e-17 * scale:
            break
        for row in range(size):
            for column in range(row):
                _turn_to_nothing(symmetric, vectors, row, column)
    best = 0
    for index in range(size):
        if symmetric[index, index] > symmetric[best, best]:
            best = index
    return vectors[:, best] if not np.isnan(symmetric).any() else np.full(size, np.nan)


@njit(cache=True, nogil=True)
def _turn_to_nothing(symmetric: Array, vectors: Array, row: int, column: int) -> None:
    """Rotate two axes so that the element of both becomes 0."""
    element = symmetric[row, column]
    if abs(element) <= 1e-20 * (abs(symmetric[row, row]) + abs(symmetric[column, column])):
        return
    ratio = (symmetric[column, column] - symmetric[row, row]) / (2.0 * element)
    tangent = (1.0 if ratio >= 0.0 else -1.0) / (abs(ratio) + np.sqrt(1.0 + ratio * ratio))
    cosine = 1.0 / np.sqrt(1.0 + tangent * tangent)
    sine = tangent * cosine
    for index in range(len(symmetric)):
        one, other = symmetric[index, row], symmetric[index, column]
        symmetric[index, row] = cosine * one - sine * other
        symmetric[index, column] = sine * one + cosine * other
    for index in range(len(symmetric)):
        one, other = symmetric[row, index], symmetric[column, index]
        symmetric[row, index] = cosine * one - sine * other
        symmetric[column, index] = sine * one + cosine * other
        one, other = vectors[index, row], vectors[index, column]
        vectors[index, row] = cosine * one - sine * other
        vectors[index, column] = sine * one + cosine * other


@njit(cache=True, nogil=True)
def nearest_rotation(matrix: Array, rotation: Array) -> None:
    """Fill ``rotation`` (3, 3) with the rotation R that makes tr(Rᵀ matrix) greatest: the
    orthogonal Procrustes problem, by quaternions (Horn 1987, section 4)."""
    a, b, c = matrix[0]
    d, e, f = matrix[1]
    g, h, i = matrix[2]
    symmetric = np.empty((4, 4))
    symmetric[0, 0], symmetric[0, 1] = a + e + i, h - f
    symmetric[0, 2], symmetric[0, 3] = c - g, d - b
    symmetric[1, 1], symmetric[1, 2], symmetric[1, 3] = a - e - i, b + d, c + g
    symmetric[2, 2], symmetric[2, 3], symmetric[3, 3] = e - a - i, f + h, i - a - e
    for row in range(4):
        for column in range(row):
            symmetric[row, column] = symmetric[column, row]
    set_matrix(rotation, quaternion_in(principal_vector(symmetric)))
