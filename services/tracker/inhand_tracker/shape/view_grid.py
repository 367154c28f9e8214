"""A grid of all directions that says which of a few may be nearest (``kernels/nearest_view``)."""

from functools import lru_cache
from itertools import product

import numpy as np
from numpy.typing import NDArray

from inhand_tracker.geometry.arrays import Indices, Singles
from inhand_tracker.shape.kernels.nearest_view import CELLS, Candidates

CHUNK = 256
"""Number of cells that are compared with all directions at once, to bound the memory."""


def view_grid(directions: NDArray[np.floating]) -> Candidates:
    """Find which of the unit directions (V, 3) may be the nearest in each cell of a grid on the six
    sides of a cube, (6, CELLS, CELLS, C); -1 for no more.

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
    cells = middles.reshape(-1, 3)
    found = [
        (start, *_possible(cells[start : start + CHUNK], unit))
        for start in range(0, len(cells), CHUNK)
    ]
    most = 1 + max(int(places.max()) for _, _, places, _ in found)
    grid = np.full((len(cells), most), -1, np.int16)
    for start, rows, places, views in found:
        grid[start + rows, places] = views
    return grid.reshape(6, CELLS, CELLS, -1)


def _possible(middles: Singles, unit: Singles) -> tuple[Indices, Indices, Indices]:
    """Find what may be nearest to some cells: the cell, its how manieth, and which direction."""
    angles = np.arccos(np.clip(middles @ unit.T, -1.0, 1.0))
    radius = np.sqrt(2.0) / CELLS
    possible = angles <= angles.min(axis=1, keepdims=True) + 2.0 * radius
    rows, views = np.nonzero(possible)
    places = np.cumsum(possible, axis=1)[rows, views] - 1
    return rows, places, views
