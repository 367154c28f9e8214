"""Squared distances of one body from landmarks, and what is near it."""

import numpy as np
from inhand_runtime.compiled import njit

from inhand_tracker.geometry.arrays import Array, Singles

FARTHEST = 8.0
"""Exponent beyond which a landmark's share is next to nothing, 0.0003, beside the nearest's."""


@njit(cache=True, nogil=True, fastmath={"reassoc", "contract"})
def distances_of(one: Singles, landmarks: Singles) -> Array:
    """Return the squared distances (L,) of (D,) from landmarks (L, D).

    Differences are squared, not squares subtracted: so single precision does, which reads half as
    much.
    """
    distances = np.empty(len(landmarks))
    for landmark in range(len(landmarks)):
        square = np.float32(0.0)
        for index in range(len(one)):
            off = one[index] - landmarks[landmark, index]
            square += off * off
        distances[landmark] = square
    return distances


@njit(cache=True, nogil=True, fastmath={"reassoc", "contract"})
def nearest_of(distances: Array, width: float, values: Array) -> tuple[float, float, float]:
    """Return the least of squared distances (L,), and means of two ``values`` (L, 2) by the squares
    of kernels of a squared ``width``, which is as ``combination.locality`` weighs landmarks."""
    least = distances.min()
    total, first, second = 0.0, 0.0, 0.0
    for landmark in range(len(distances)):
        off = (distances[landmark] - least) / width
        if off < FARTHEST:
            share = np.exp(-off)
            total += share
            first += share * values[landmark, 0]
            second += share * values[landmark, 1]
    return least, first / total, second / total
