"""Whether an object is there at all: what an image's support for it says, as learned.

A tracker looks for its object whether it is there or not, and always finds something that resembles
it. How well is different for a broom and for glasses: so the support where it was found rightly is
compared with that in images of other things in use, in each by a normal distribution of one
variance (linear discriminant analysis). Only things that were taught are among those images: of
those that nobody taught, some look as the object does.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

CERTAIN = 6.0
"""How much the looks of the last moments can say at the most, for or against."""
ALIKE = 1.0 / 6.0
"""Of things that nobody taught, the share taken to look as the object does: so an image can say no
more for an object than log(1 / ALIKE), whatever it says against."""
LOOKS_S = 0.7
"""Looks of so long ago count for a third as much: one frame errs as the next does."""
FORGOTTEN_S = 4.0
"""What was seen so long ago says a third as much."""


@dataclass(frozen=True)
class Presence:
    """The mean support (K,) of objects that are ``absent`` and ``present``, and its ``spread``."""

    absent: Array
    present: Array
    spread: Array

    def evidence(self, number: int, support: float) -> float:
        """Log evidence that an object is there which has so much support."""
        apart = (self.present[number] - self.absent[number]) / self.spread[number] ** 2
        middle = 0.5 * (self.present[number] + self.absent[number])
        of_taught = float(np.clip(apart * (support - middle), -CERTAIN, CERTAIN))
        return of_taught - float(np.log1p(ALIKE * np.expm1(of_taught)))


class Looks:
    """The last looks at each object: a thing that resembles one does so in every frame, so looks
    are averaged, and do not add up."""

    def __init__(self, presence: Presence) -> None:
        self._presence = presence
        self.restart()

    def restart(self) -> None:
        """Another scene."""
        self._supports: dict[int, tuple[float, float, int]] = {}

    def add(self, time_ns: int, supports: Mapping[int, float]) -> None:
        """Take the supports of those objects that were looked for in a frame."""
        for number, support in supports.items():
            mean, count, before_ns = self._supports.get(number, (0.0, 0.0, time_ns))
            kept = count * np.exp(-max(time_ns - before_ns, 0) / 1e9 / LOOKS_S)
            self._supports[number] = (
                (kept * mean + support) / (kept + 1.0),
                kept + 1.0,
                time_ns,
            )

    def evidence(self, time_ns: int) -> Array:
        """Log evidence (K + 1,) for each object, and, last, for none; 0 where nobody looked."""
        evidence = np.zeros(len(self._presence.absent) + 1)
        for number, (mean, _, seen_ns) in self._supports.items():
            age = max(time_ns - seen_ns, 0) / 1e9
            evidence[number] = np.exp(-age / FORGOTTEN_S) * self._presence.evidence(number, mean)
        return evidence


def usual_presence(objects: int) -> Presence:
    """That of most objects, where none was learned (simulated people of seed 71)."""
    ones = np.ones(objects)
    return Presence(6.0 * ones, 24.0 * ones, 8.0 * ones)
