"""Whether an object is there at all: what an image's support for it says, as learned.

A tracker looks for its object whether it is there or not, and always finds something that resembles
it. How well is different for a broom and for glasses: so the support where it was found rightly is
compared with that in images of other things in use, in each by a normal distribution of one
variance (linear discriminant analysis).
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

CERTAIN = 6.0
"""How much one image can say at the most, for or against: what it errs in, others err in too."""
WEIGHT = 3.0
"""An image tells so many times more that is new than a movement, which hardly changes."""


@dataclass(frozen=True)
class Presence:
    """The mean support (K,) of K objects that are ``absent`` and ``present``, and its ``spread``."""

    absent: Array
    present: Array
    spread: Array

    def evidence(self, supports: Mapping[int, float]) -> Array:
        """Log evidence (K + 1,) for each object, and, last, for none; 0 for those not looked for."""
        evidence = np.zeros(len(self.absent) + 1)
        for number, support in supports.items():
            apart = (self.present[number] - self.absent[number]) / self.spread[number] ** 2
            middle = 0.5 * (self.present[number] + self.absent[number])
            evidence[number] = np.clip(apart * (support - middle), -CERTAIN, CERTAIN)
        return WEIGHT * evidence


def usual_presence(objects: int) -> Presence:
    """That of most objects, where none was learned (simulated people of seed 71)."""
    ones = np.ones(objects)
    return Presence(6.0 * ones, 24.0 * ones, 8.0 * ones)
