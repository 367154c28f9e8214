"""Rows of numbers that are kept sorted while one takes the place of another."""

import numpy as np
from numpy.typing import NDArray

from inhand_runtime.compiled import njit

Numbers = NDArray[np.float64]
Counts = NDArray[np.int64]


@njit(cache=True, nogil=True)
def exchange(ordered: Numbers, counts: Counts, old: Numbers, new: Numbers) -> None:
    """Take ``old`` values (N,) out of the rows of ``ordered`` (N, T), and put ``new`` ones in.

    The first ``counts`` (N,) of each row are sorted. NaN is neither in a row nor put there.
    """
    for row in range(len(ordered)):
        values, count = ordered[row], counts[row]
        if not np.isnan(old[row]):
            place = np.searchsorted(values[:count], old[row])
            for index in range(place, count - 1):
                values[index] = values[index + 1]
            count -= 1
        if not np.isnan(new[row]):
            place = count
            while place > 0 and values[place - 1] > new[row]:
                values[place] = values[place - 1]
                place -= 1
            values[place] = new[row]
            count += 1
        counts[row] = count


@njit(cache=True, nogil=True)
def medians(ordered: Numbers, counts: Counts) -> Numbers:
    """Return the median (N,) of each row of ``ordered`` (N, T); NaN for an empty one."""
    found = np.full(len(ordered), np.nan)
    for row in range(len(ordered)):
        count = counts[row]
        if count > 0:
            found[row] = 0.5 * (ordered[row, (count - 1) // 2] + ordered[row, count // 2])
    return found
