"""Lengths of a body's parts: their running medians, kept sorted, and wild ones among them."""

import numpy as np
from inhand_runtime.compiled import njit

from inhand_tracker.geometry.arrays import Array, Indices


@njit(cache=True, nogil=True)
def exchange(ordered: Array, counts: Indices, old: Array, new: Array) -> None:
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
def medians(ordered: Array, counts: Indices) -> Array:
    """Return the median (N,) of each row of ``ordered`` (N, T); NaN for an empty one."""
    found = np.full(len(ordered), np.nan)
    for row in range(len(ordered)):
        count = counts[row]
        if count > 0:
            found[row] = 0.5 * (ordered[row, (count - 1) // 2] + ordered[row, count // 2])
    return found


@njit(cache=True, nogil=True)
def in_proportion(lengths: Array, proportions: Array, wild_ratio: float) -> Array:
    """Return lengths (N,), the wild ones of which have the value that the others make one expect.

    ``proportions`` (N,) are usual lengths, in any unit. Missing lengths (NaN) stay missing.
    """
    shares = lengths / np.maximum(proportions, 1e-9)
    seen = shares[np.isfinite(shares)]
    if len(seen) == 0:
        return lengths
    typical = np.median(seen)
    expected = lengths.copy()
    for part in range(len(lengths)):
        if shares[part] > wild_ratio * typical or shares[part] < typical / wild_ratio:
            expected[part] = typical * proportions[part]
    return expected
