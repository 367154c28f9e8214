"""Lengths of a body's parts, and wild ones among them."""

import numpy as np
from inhand_runtime.compiled import njit

from inhand_tracker.geometry.arrays import Array


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
