"""Judges whether an object is there at all, by what an image's support for it says.

A tracker looks for its object whether it is there or not, and always finds something that resembles
it. How well depends on the object, and on what is there instead: a golf club resembles a broom more
than glasses do. So support is compared with that in images of each thing that was taught, by normal
distributions of one variance (linear discriminant analysis). A thing that nobody taught is as
likely to resemble the object as each of the things that were, the object itself among them.

A thing that resembles the object in one way seldom does in all: each part of the support may fall
short of that in the object's own images only as far as it does among these. And a thing of another
colour betrays itself: a tracker that follows it learns its colours, and what they say of it is more
than the colours of training do.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.recognition.parameters import DEFAULT_RECOGNITION, RecognitionParameters
from inhand_tracker.sight.support import INTERIOR, PARTS, Support


@dataclass(frozen=True)
class Presence:
    """Keeps what images say of K objects, learned from images of each of them.

    ``supports`` (K, K) are the mean supports of each object (row) in images of each one, on the
    diagonal of itself; ``spread`` (K,) their standard deviations. ``parts`` (K, 4) are the means of
    the parts of each object's support in images of itself, ``part_spreads`` (K, 4) their standard
    deviations. An object that was never seen has parts of -∞.
    """

    supports: Array
    spread: Array
    parts: Array
    part_spreads: Array

    def evidence(
        self,
        number: int,
        support: Support,
        parameters: RecognitionParameters = DEFAULT_RECOGNITION,
    ) -> float:
        """Log evidence of a support that its object is there, by the object's number.

        At the most it is log K and what images are trusted.
        """
        apart = (support.log_likelihood - self.supports[number]) / self.spread[number]
        logs = -0.5 * np.square(apart)
        logs -= logs.max()
        usual = np.log(np.exp(logs).mean())
        spreads = self.part_spreads[number]
        short = np.maximum(self.parts[number] - support.parts, 0.0) / spreads
        recoloured = max(support.recoloured, 0.0) / (
            parameters.recoloured_spread * spreads[INTERIOR]
        )
        misfit = 0.5 * (parameters.part_temper * short @ short + recoloured**2)
        evidence = logs[number] - usual - misfit + parameters.trust
        return float(np.maximum(evidence, -parameters.most_against))


@dataclass(frozen=True)
class _MeanLook:
    """The mean of the last looks at an object, what they count for, and when the newest was.

    ``support`` (5,) are the fields of a Support.
    """

    support: Array
    count: float
    time_ns: int


class Looks:
    """Keeps the mean of the last looks at each object.

    A thing that resembles an object does so in every frame: looks do not add up.
    """

    def __init__(
        self, presence: Presence, parameters: RecognitionParameters = DEFAULT_RECOGNITION
    ) -> None:
        self._presence = presence
        self._parameters = parameters
        self.restart()

    def restart(self) -> None:
        """Start anew: another scene."""
        self._means: dict[int, _MeanLook] = {}

    def add(self, time_ns: int, supports: Mapping[int, Support]) -> None:
        """Take the supports, by number, of the objects that were looked for in a frame."""
        for number, support in supports.items():
            mean = self._means.get(number, _MeanLook(np.zeros(PARTS + 1), 0.0, time_ns))
            elapsed_s = max(time_ns - mean.time_ns, 0) / 1e9
            kept = mean.count * np.exp(-elapsed_s / self._parameters.looks_s)
            support_mean = (kept * mean.support + np.array(support)) / (kept + 1.0)
            self._means[number] = _MeanLook(support_mean, kept + 1.0, time_ns)

    def evidence(self, time_ns: int) -> Array:
        """Log evidence (K + 1,) for each object, and, last, for none; 0 where nobody looked."""
        evidence = np.zeros(len(self._presence.spread) + 1)
        for number, mean in self._means.items():
            age_s = max(time_ns - mean.time_ns, 0) / 1e9
            fresh = self._presence.evidence(number, Support(*mean.support), self._parameters)
            evidence[number] = np.exp(-age_s / self._parameters.forgotten_s) * fresh
        return evidence


def usual_presence(
    objects: int, parameters: RecognitionParameters = DEFAULT_RECOGNITION
) -> Presence:
    """Give what images say of most objects, where none of it was learned."""
    there = np.eye(objects, dtype=bool)
    return Presence(
        np.where(there, parameters.usual_support_present, parameters.usual_support_absent),
        np.full(objects, parameters.usual_support_spread),
        np.full((objects, PARTS), -np.inf),
        np.tile(parameters.usual_part_spreads, (objects, 1)),
    )
