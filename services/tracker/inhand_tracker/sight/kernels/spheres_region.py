"""The part of an image in which spheres are."""

import numpy as np
from inhand_runtime.compiled import njit

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import NEAREST_M
from inhand_tracker.sight.kernels.projection import projected


@njit(cache=True, nogil=True)
def spheres_region(centres: Array, radius: float, lens: Array) -> tuple[float, float, float, float]:
    """Return left, top, right and bottom, in pixels, of spheres about ``centres`` (P, 3) of one
    radius, seen through a ``lens`` (fx, fy, cx, cy); those behind the camera do not count.

    Where all are, the first two are infinite and the others minus infinite.
    """
    left, top, right, bottom = np.inf, np.inf, -np.inf, -np.inf
    for index in range(len(centres)):
        x, y, z = centres[index]
        if not z > NEAREST_M:
            continue
        u, v = projected(lens, x, y, z)
        around = radius * max(lens[0], lens[1]) / z
        if np.isfinite(u) and np.isfinite(v):
            left, right = min(left, u - around), max(right, u + around)
            top, bottom = min(top, v - around), max(bottom, v + around)
    return left, top, right, bottom
