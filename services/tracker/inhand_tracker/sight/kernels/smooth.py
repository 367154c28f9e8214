"""Spreading a histogram of colours to neighbouring ones."""

import numpy as np
from inhand_runtime.compiled import njit

from inhand_tracker.geometry.arrays import Singles


@njit(cache=True, nogil=True)
def smooth(histogram: Singles, levels: int, weight: float, smoothed: Singles) -> None:
    """Fill ``smoothed`` (levels³,) with a histogram (levels³,) of which each level's neighbours
    along each axis get ``weight`` times as much as stays; at the ends what would go out stays."""
    around, middle = (
        np.float32(weight / (1.0 + 2.0 * weight)),
        np.float32(1.0 / (1.0 + 2.0 * weight)),
    )
    smoothed[:] = histogram
    line = np.empty(levels, np.float32)
    stride = 1
    for _ in range(3):
        for start in range(levels * levels):
            first = start // stride * stride * levels + start % stride
            for level in range(levels):
                line[level] = smoothed[first + level * stride]
            for level in range(levels):
                below, above = max(level - 1, 0), min(level + 1, levels - 1)
                smoothed[first + level * stride] = middle * line[level] + around * (
                    line[below] + line[above]
                )
        stride *= levels
