"""Whether an object is there at all: what an image's support for it says, as learned.

A tracker looks for its object whether it is there or not, and always finds something that resembles
it. How well is different for a broom and for glasses, and for a broom where there is a golf club:
so support is compared with that in images of each thing that was taught, by normal distributions of
one variance (linear discriminant analysis). What nobody taught is as likely to resemble the object
as each of the things that were: as the object itself does, too.

A thing of another colour betrays itself: a tracker that follows it learns its colours, and what
they say of it is more than the colours of training do.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

CERTAIN = 6.0
"""How much the looks of the last moments can say against an object at the most."""
USUALLY_PRESENT, USUALLY_ABSENT, USUAL_SPREAD = 24.0, 6.0, 8.0
"""Support of most objects (simulated people of seed 71)."""
USUAL_INTERIOR_SPREAD = 1.0
"""The same of its part that colours have all over an object (simulated people of seed 31)."""
RECOLOURED = 0.7
"""By so much of that an object's own colours may be learned anew, as the same people's were."""
TRUSTED = 0.5
"""So much images say for an object beforehand: those of one that is there are seldom its best ones
(the same people)."""
LOOKS_S = 2.0
"""Looks of so long ago count for a third as much: one frame errs as the next does."""
FORGOTTEN_S = 4.0
"""What was seen so long ago says a third as much."""


class Support(NamedTuple):
    """What an image says for an object at the likeliest pose."""

    log_likelihood: float
    """How many times likelier (log) it is with the object, in its colours of training, than
    without."""
    interior: float
    """What colours all over the object say of that."""
    recoloured: float = 0.0
    """How much more they say with the colours that were learned since."""


@dataclass(frozen=True)
class Presence:
    """The mean ``supports`` (K, K) of each object in images of each one, of itself on the diagonal,
    their ``spread`` (K,), and the spread of their part from colours all over an object that is
    there, ``interior_spread`` (K,)."""

    supports: Array
    spread: Array
    interior_spread: Array

    @property
    def present(self) -> Array:
        """The mean support (K,) of objects that are there."""
        return np.diagonal(self.supports)

    def evidence(self, number: int, support: Support) -> float:
        """Log evidence that an object is there which has such support: at the most log K, and what
        images are trusted."""
        apart = (support.log_likelihood - self.supports[number]) / self.spread[number]
        logs = -0.5 * np.square(apart)
        logs -= logs.max()
        usual = np.log(np.exp(logs).mean())
        recoloured = max(support.recoloured, 0.0) / (RECOLOURED * self.interior_spread[number])
        told = TRUSTED + logs[number] - usual - 0.5 * recoloured**2
        return float(np.maximum(told, -CERTAIN))


class Looks:
    """The last looks at each object: a thing that resembles one does so in every frame, so looks
    are averaged, and do not add up."""

    def __init__(self, presence: Presence) -> None:
        self._presence = presence
        self.restart()

    def restart(self) -> None:
        """Another scene."""
        self._supports: dict[int, tuple[Array, float, int]] = {}

    def add(self, time_ns: int, supports: Mapping[int, Support]) -> None:
        """Take the supports of those objects that were looked for in a frame."""
        for number, support in supports.items():
            mean, count, before_ns = self._supports.get(number, (np.zeros(3), 0.0, time_ns))
            kept = count * np.exp(-max(time_ns - before_ns, 0) / 1e9 / LOOKS_S)
            self._supports[number] = (
                (kept * mean + np.array(support)) / (kept + 1.0),
                kept + 1.0,
                time_ns,
            )

    def evidence(self, time_ns: int) -> Array:
        """Log evidence (K + 1,) for each object, and, last, for none; 0 where nobody looked."""
        evidence = np.zeros(len(self._presence.spread) + 1)
        for number, (mean, _, seen_ns) in self._supports.items():
            age = max(time_ns - seen_ns, 0) / 1e9
            told = self._presence.evidence(number, Support(*mean))
            evidence[number] = np.exp(-age / FORGOTTEN_S) * told
        return evidence


def usual_presence(objects: int) -> Presence:
    """That of most objects, where none was learned."""
    there = np.eye(objects, dtype=bool)
    return Presence(
        np.where(there, USUALLY_PRESENT, USUALLY_ABSENT),
        np.full(objects, USUAL_SPREAD),
        np.full(objects, USUAL_INTERIOR_SPREAD),
    )
