"""Bins of pixels to a histogram."""

import numpy as np
from inhand_runtime.compiled import njit
from numpy.typing import NDArray

from inhand_tracker.geometry.arrays import Singles


@njit(cache=True, nogil=True)
def count(bins: NDArray[np.uint16], weights: Singles, counts: Singles) -> None:
    """Add the weights (H, W) of pixels to the ``counts`` (4096,) of their bins (H, W)."""
    for row in range(bins.shape[0]):
        for column in range(bins.shape[1]):
            counts[bins[row, column]] += weights[row, column]
