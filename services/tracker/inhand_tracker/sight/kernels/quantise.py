"""Colours to bins of a histogram."""

import numpy as np
from inhand_runtime.compiled import njit
from numpy.typing import NDArray

from inhand_tracker.geometry.arrays import Bytes


@njit(cache=True, nogil=True)
def quantise(colour: Bytes, bins: NDArray[np.uint16]) -> None:
    """Fill ``bins`` (H, W) with the bin of each colour (H, W, 3): 16 levels of each channel."""
    for row in range(colour.shape[0]):
        for column in range(colour.shape[1]):
            red, green, blue = colour[row, column]
            bins[row, column] = ((red >> 4) << 8) | ((green >> 4) << 4) | (blue >> 4)
