"""A tracker's estimate of a pose, and the estimate that weighted particles give."""

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.placement import Placement
from inhand_tracker.geometry.pose_gaussian import turn_blocks

# What confidence is, is part of the message (ObjectPose.confidence): it cannot be tuned.
AGREEMENT_M = 0.10
"""Metres from an estimate within which a pose agrees with it."""
AGREEMENT_RAD = np.deg2rad(30.0)
"""Radians from an estimate within which a pose agrees with it."""


@dataclass(frozen=True)
class Estimate:
    """An object's pose in the camera frame in one frame; a lost object has none.

    ``translation`` (3,) in metres, ``rotation`` (4,), ``covariance`` (6, 6) of (translation,
    rotation vector on the left); ``confidence`` is the probability that the true pose is within
    10 cm and 30° of this one. ``ageing`` says how "tracked" becomes "predicted" and then "lost".
    """

    state: Literal["tracked", "predicted", "lost"]
    confidence: float
    translation: Array | None = None
    rotation: Array | None = None
    covariance: Array | None = None

    def seen_from(self, place: Placement) -> "Estimate":
        """Return the estimate in the frame of a camera, ``view_from_reference`` from where it is
        in."""
        if self.translation is None or self.rotation is None:
            return self
        translation, rotation = place.poses(self.translation, self.rotation)
        turned = None
        if self.covariance is not None:
            turned = turn_blocks(self.covariance, rotations.to_matrix(place.rotation))
        return replace(self, translation=translation, rotation=rotation, covariance=turned)


LOST = Estimate("lost", 0.0)
"""The estimate of an object that nobody knows the place of."""


def weighted_estimate(translations: Array, orientations: Array, weights: Array) -> Estimate:
    """Estimate the expected pose of weighted particles (P, 3) and (P, 4).

    Darby et al. 2014, equations 18 and 19; the mean rotation is that of Markley et al. 2007.
    """
    translation = weights @ translations
    rotation = rotations.mean(orientations, weights)
    offsets = translations - translation
    turns = rotations.to_vector(rotations.multiply(orientations, rotations.conjugate(rotation)))
    deviations = np.concatenate((offsets, turns), axis=1)
    agreeing = (np.linalg.norm(offsets, axis=1) < AGREEMENT_M) & (
        np.linalg.norm(turns, axis=1) < AGREEMENT_RAD
    )
    return Estimate(
        "tracked",
        float(min(weights @ agreeing, 1.0)),
        translation,
        rotation,
        np.einsum("p,pi,pj->ij", weights, deviations, deviations),
    )
