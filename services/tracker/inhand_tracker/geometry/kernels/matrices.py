"""Algebra of small symmetric matrices (N, N): their triangular roots, and what these solve."""

import numpy as np
from inhand_runtime.compiled import njit

from inhand_tracker.geometry.arrays import Array


@njit(cache=True, nogil=True)
def find_root(matrix: Array, root: Array) -> bool:
    """Fill the lower triangle of ``root`` with L, where L Lᵀ is a matrix (its lower triangle is
    read; both may be one array). Returns whether the matrix is positive definite: else the root
    is not to be used."""
    for row in range(len(matrix)):
        for column in range(row + 1):
            total = matrix[row, column]
            for k in range(column):
                total -= root[row, k] * root[column, k]
            if row == column:
                if not total > 0.0:
                    return False
                root[row, row] = np.sqrt(total)
            else:
                root[row, column] = total / root[column, column]
    return True


@njit(cache=True, nogil=True)
def solve_lower(root: Array, vector: Array) -> None:
    """Put L⁻¹ v in place of a vector (N,)."""
    for row in range(len(vector)):
        total = vector[row]
        for k in range(row):
            total -= root[row, k] * vector[k]
        vector[row] = total / root[row, row]


@njit(cache=True, nogil=True)
def solve(root: Array, vector: Array) -> None:
    """Put (L Lᵀ)⁻¹ v in place of a vector (N,)."""
    solve_lower(root, vector)
    for row in range(len(vector) - 1, -1, -1):
        total = vector[row]
        for k in range(row + 1, len(vector)):
            total -= root[k, row] * vector[k]
        vector[row] = total / root[row, row]


@njit(cache=True, nogil=True)
def invert(root: Array, inverse: Array) -> None:
    """Fill ``inverse`` with (L Lᵀ)⁻¹."""
    inverse[:] = 0.0
    for column in range(len(root)):
        inverse[column, column] = 1.0
        solve(root, inverse[column])
