"""Which of some directions is the nearest to a given one, by a look-up."""

from functools import lru_cache
from itertools import product
from typing import Any, TypeAlias

import numpy as np
from numba import njit
from numpy.typing import NDArray

from inhand_tracker.geometry.arrays import Array, Indices

Real: TypeAlias = Any
"""float32 or float64, or an array of it."""
Candidates = NDArray[np.int16]

CELLS = 48


def view_grid(directions: NDArray[np.floating]) -> Candidates:
    """(6, CELLS, CELLS, C): which of the unit directions (V, 3) may be the nearest, -1 for none
    more, in each cell of a grid on the six sides of a cube.

    What is nearest to the middle of a cell by more than the cell's width is nearest everywhere in
    it, so that C is small and the look-up is exact.
    """
    unit = np.ascontiguousarray(directions, np.float32)
    return _grid(unit.tobytes(), len(unit))


@lru_cache(maxsize=8)
def _grid(directions: bytes, count: int) -> Candidates:
    unit = np.frombuffer(directions, np.float32).reshape(count, 3)
    edges = (np.arange(CELLS) + 0.5) * 2.0 / CELLS - 1.0
    first, second = np.meshgrid(edges, edges, indexing="ij")
    middles = np.empty((6, CELLS, CELLS, 3), np.float32)
    for axis, sign in product(range(3), (0, 1)):
        side = middles[2 * axis + sign]
        side[..., axis] = 2.0 * sign - 1.0
        side[..., (axis + 1) % 3], side[..., (axis + 2) % 3] = first, second
    middles /= np.linalg.norm(middles, axis=-1, keepdims=True)
    angles = np.arccos(np.clip(middles.reshape(-1, 3) @ unit.T, -1.0, 1.0))
    radius = np.sqrt(2.0) / CELLS
    possible = angles <= angles.min(axis=1, keepdims=True) + 2.0 * radius
    places = np.cumsum(possible, axis=1) - 1
    grid = np.full((len(possible), int(places.max()) + 1), -1, np.int16)
    cell, view = np.nonzero(possible)
    grid[cell, places[cell, view]] = view
    return grid.reshape(6, CELLS, CELLS, -1)


@njit(cache=True, nogil=True)
def nearest_views(grid: Candidates, directions: Array, towards_viewer: Array) -> Indices:
    """The indices (P,) of the directions (V, 3) nearest to vectors (P, 3) of any length."""
    views = np.empty(len(towards_viewer), np.int64)
    for index in range(len(towards_viewer)):
        x, y, z = towards_viewer[index]
        views[index] = nearest_view(grid, directions, x, y, z)
    return views


@njit(cache=True, nogil=True, inline="always")
def nearest_view(grid: Candidates, directions: Real, x: Real, y: Real, z: Real) -> int:
    """The index of the direction nearest to (x, y, z), of any length but zero."""
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
