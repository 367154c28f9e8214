"""Recursion along time: sums that leak."""

from __future__ import annotations

import numpy as np
from inhand_tracker.geometry.arrays import Array


def leaky_sum(values: Array, kept: float, before: Array | float) -> Array:
    """Running sums (T, ...) of values (T, ...), of which a share is kept from one to the next.

    ``before`` (...) is the sum before the first value.
    """
    sums = np.empty_like(values)
    last = before
    for index, value in enumerate(values):
        last = sums[index] = kept * last + value
    return sums
