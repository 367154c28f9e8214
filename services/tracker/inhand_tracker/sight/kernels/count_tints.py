"""How colours of a picture, and its steps from pixel to pixel, are tinted: one pass over it."""

import numpy as np
from inhand_runtime.compiled import njit

from inhand_tracker.geometry.arrays import Array, Bytes


@njit(cache=True, nogil=True)
def count_tints(
    small: Bytes, measured: Bytes, logs: Array, widest: float, counts: Array, squares: Array
) -> tuple[int, int]:
    """Add the well ``measured`` (256,) pixels of a picture (H, W, 3) to the ``counts`` (C, C) of
    cells of log(red / green) and log(blue / green), up to ``widest`` either way, and their steps to
    well measured neighbours to the ``squares`` (3,).

    ``logs`` (256,) are those of levels. Returns how many pixels and how many steps were added.
    """
    height, width, _ = small.shape
    cells = len(counts)
    scale = 0.5 * cells / widest
    usable = np.zeros((height + 1, width + 1), np.uint8)
    pixels = steps = 0
    for row in range(height):
        for column in range(width):
            red, green, blue = small[row, column]
            if not (measured[red] and measured[green] and measured[blue]):
                continue
            usable[row + 1, column + 1] = 1
            pixels += 1
            first = (min(max(logs[red] - logs[green], -widest), widest) + widest) * scale
            second = (min(max(logs[blue] - logs[green], -widest), widest) + widest) * scale
            counts[min(int(first), cells - 1), min(int(second), cells - 1)] += 1.0
            for other_row, other_column in ((row, column - 1), (row - 1, column)):
                if not usable[other_row + 1, other_column + 1]:
                    continue
                steps += 1
                for channel in range(3):
                    step = float(small[row, column, channel])
                    step -= float(small[other_row, other_column, channel])
                    squares[channel] += step * step
    return pixels, steps
