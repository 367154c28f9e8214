"""The normal distribution's share below a limit, on arrays."""

import numpy as np

from inhand_outcomes.arrays import Array


def normal_share(z: Array | float) -> Array:
    """Share (...) of a normal distribution below z deviations, to within 0.0002.

    scipy.special, for its exact value, costs the daemon memory.
    """
    t = 1.0 / (1.0 + 0.2316419 * np.abs(z))
    series = t * (
        0.319381530 + t * (-0.356563782 + t * (1.781477937 + t * (-1.821255978 + t * 1.330274429)))
    )
    tail = np.exp(-0.5 * np.asarray(z) ** 2) / np.sqrt(2.0 * np.pi) * series
    return np.where(np.asarray(z) > 0.0, 1.0 - tail, tail)
