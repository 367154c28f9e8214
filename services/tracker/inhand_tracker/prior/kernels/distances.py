"""Squared distances of one body from landmarks, and the least of them."""

import numpy as np
from inhand_runtime.compiled import njit

from inhand_tracker.geometry.arrays import Array, Singles


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
def least_distance(one: Singles, landmarks: Singles) -> float:
    """Return the squared distance of (D,) from the nearest of landmarks (L, D)."""
    least = np.float32(np.inf)
    for landmark in range(len(landmarks)):
        square = np.float32(0.0)
        for index in range(len(one)):
            off = one[index] - landmarks[landmark, index]
            square += off * off
        if square < least:
            least = square
    return float(least)
