"""Recursive filters along time."""

from __future__ import annotations

import numpy as np

from inhand_lab.transforms import Floats


def leaky_sum(values: Floats, kept: float, before: Floats | float) -> Floats:
    """Running sums (T, ...) of values (T, ...), of which a share is kept from one to the next.

    ``before`` (...) is the sum before the first value.
    """
    sums = np.empty_like(values)
    last = before
    for index, value in enumerate(values):
        last = sums[index] = kept * last + value
    return sums
