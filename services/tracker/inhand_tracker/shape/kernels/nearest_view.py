"""The nearest of some directions, by a look-up in a grid of candidates (``view_grid``)."""

from typing import Any, TypeAlias

import numpy as np
from inhand_runtime.compiled import njit
from numpy.typing import NDArray

from inhand_tracker.geometry.arrays import Array, Indices

Real: TypeAlias = Any
"""float32 or float64, or an array of it."""
Candidates = NDArray[np.int16]

CELLS = 48
"""Number of cells along each side of the cube: with 642 directions 6 candidates a cell or fewer."""


@njit(cache=True, nogil=True)
def nearest_views(grid: Candidates, directions: Array, towards_viewer: Array) -> Indices:
    """Find the indices (P,) of the directions (V, 3) nearest to vectors (P, 3) of any length."""
    views = np.empty(len(towards_viewer), np.int64)
    for index in range(len(towards_viewer)):
        x, y, z = towards_viewer[index]
        views[index] = nearest_view(grid, directions, x, y, z)
    return views


@njit(cache=True, nogil=True, inline="always")
def nearest_view(grid: Candidates, directions: Real, x: Real, y: Real, z: Real) -> int:
    """Find the index of the direction nearest to (x, y, z), of any length but zero."""
    ax, ay, az = abs(x), abs(y), abs(z)
    if ax >= ay and ax >= az:
        side, scale, first, second = (1 if x > 0.0 else 0), ax, y, z
    elif ay >= az:
        side, scale, first, second = (3 if y > 0.0 else 2), ay, z, x
    else:
        side, scale, first, second = (5 if z > 0.0 else 4), az, x, y
    half = np.float32(0.5 * CELLS)
    scale = max(scale, np.float32(1e-12))
    row = min(int((first / scale + np.float32(1.0)) * half), CELLS - 1)
    column = min(int((second / scale + np.float32(1.0)) * half), CELLS - 1)
    best, most = 0, np.float32(-1e30)
    for place in range(grid.shape[3]):
        view = grid[side, row, column, place]
        if view < 0:
            break
        agreement = directions[view, 0] * x + directions[view, 1] * y + directions[view, 2] * z
        if agreement > most:
            best, most = view, agreement
    return best
