"""Which way somebody faces by a network's points, and whether they can have turned there."""

from dataclasses import dataclass

import numpy as np

from inhand_capture.estimation.found_person import Floats
from inhand_capture.estimation.landmarks import Landmarks
from inhand_capture.estimation.regions import Region

LEFTS, RIGHTS = [11, 23], [12, 24]
"""Points of the left and of the right: shoulders and hips."""


@dataclass(frozen=True)
class FollowedRegion:
    """Where somebody is looked for in the next picture, and how their sides have lain.

    ``across`` (2, 3) are the means of unit vectors from right to left, of shoulders and of hips.
    """

    region: Region
    across: Floats

    def after(self, found: Landmarks, share: float) -> "FollowedRegion":
        """Return what is followed after a picture that counts as that share of all before."""
        across = self.across + share * (across_of(found) - self.across)
        return FollowedRegion(found.next_region, across)


def begun_with(found: Landmarks) -> FollowedRegion:
    """Return what is followed of somebody new."""
    return FollowedRegion(found.next_region, across_of(found))


def across_of(found: Landmarks) -> Floats:
    """Return unit vectors (2, 3) from right to left, of shoulders and of hips."""
    across = found.places[LEFTS] - found.places[RIGHTS]
    unit: Floats = across / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-9)
    return unit


def agreement(found: Landmarks, before: FollowedRegion) -> float:
    """Return the lesser of the cosines by which shoulders and hips lie as they did before."""
    lengths = np.maximum(np.linalg.norm(before.across, axis=1), 1e-9)
    return float(((across_of(found) * before.across).sum(axis=1) / lengths).min())
