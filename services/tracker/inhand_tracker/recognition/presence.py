"""Whether an object is there at all: what an image's support for it says, as learned.

A tracker looks for its object whether it is there or not, and always finds something that resembles
it. How well is different for a broom and for glasses, and for a broom where there is a golf club:
so support is compared with that in images of each thing that was taught, by normal distributions of
one variance (linear discriminant analysis). What nobody taught is as likely to resemble the object
as each of the things that were: as the object itself does, too.

What resembles the object in one way seldom does in all: each part of the support may fall short of
that in the object's own images only as far as it does among these. And a thing of another colour
betrays itself: a tracker that follows it learns its colours, and what they say of it is more than
the colours of training do.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.sight.support import INTERIOR, PARTS, Support

CERTAIN = 6.0
"""How much the looks of the last moments can say against an object at the most."""
USUALLY_PRESENT, USUALLY_ABSENT, USUAL_SPREAD = 24.0, 6.0, 8.0
"""Support of most objects (simulated people of seed 71)."""
USUAL_PART_SPREADS = (2.4, 4.6, 0.7, 1.5)
"""The same of the parts of an object's own support (simulated people of seed 31)."""
TOGETHER = 0.5
"""Parts fall short together: so much of what each says by that counts."""
RECOLOURED = 0.7
"""How much colours of the object itself are learned anew, in spreads of what they say of it (the
same people)."""
TRUSTED = 1.0
"""So much images say for an object beforehand: most of them fall short of those of training (the
same people)."""
LOOKS_S = 2.0
"""Looks of so long ago count for a third as much: one frame errs as the next does."""
FORGOTTEN_S = 4.0
"""What was seen so long ago says a third as much."""


@dataclass(frozen=True)
class Presence:
    """The mean ``supports`` (K, K) of each object in images of each one, of itself on the diagonal,
    and their ``spread`` (K,); the mean ``parts`` (K, 4) of each object's support in images of
    itself and their spreads, ``part_spreads`` (K, 4). What was never seen has parts of -∞."""

    supports: Array
    spread: Array
    parts: Array
    part_spreads: Array

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
        spreads = self.part_spreads[number]
        short = np.maximum(self.parts[number] - support.parts, 0.0) / spreads
        recoloured = max(support.recoloured, 0.0) / (RECOLOURED * spreads[INTERIOR])
        told = logs[number] - usual - 0.5 * (TOGETHER * short @ short + recoloured**2) + TRUSTED
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
            mean, count, before_ns = self._supports.get(number, (np.zeros(PARTS + 1), 0.0, time_ns))
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
        np.full((objects, PARTS), -np.inf),
        np.tile(USUAL_PART_SPREADS, (objects, 1)),
    )
