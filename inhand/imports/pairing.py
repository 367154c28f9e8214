"""Which images of two streams belong together, by their times."""

import numpy as np

FARTHEST_NS = 20_000_000
"""Nanoseconds between colour and depth of one frame at the most: that of TUM's ``associate.py``."""


def nearest_partners(times: list[int], others: list[int]) -> list[int]:
    """Return, for each time, its partner of ``others``, which rise, or -1.

    The nearest pairs are made first, and each is in one pair at the most. Nanoseconds.
    """
    pairs = []
    rising = np.array(others, np.int64)
    for place, time_ns in enumerate(times):
        first = int(np.searchsorted(rising, time_ns - FARTHEST_NS))
        last = int(np.searchsorted(rising, time_ns + FARTHEST_NS, side="right"))
        pairs += [(abs(others[n] - time_ns), place, n) for n in range(first, last)]
    partners, taken = [-1] * len(times), set[int]()
    for _, place, number in sorted(pairs):
        if partners[place] < 0 and number not in taken:
            partners[place] = others[number]
            taken.add(number)
    return partners
