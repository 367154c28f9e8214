"""From weighted particles to one pose, with its covariance and confidence."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array

AGREEMENT_M = 0.10
AGREEMENT_RAD = np.deg2rad(30.0)


@dataclass(frozen=True)
class Estimate:
    """The object's pose in the camera frame.

    ``translation`` (3,), ``rotation`` (4,), ``covariance`` (6, 6) of (translation, rotation vector
    on the left), ``confidence`` the weight of the particles within 10 cm and 30° of the pose. A
    lost object has no pose.
    """

    state: Literal["tracked", "predicted", "lost"]
    confidence: float
    translation: Array | None = None
    rotation: Array | None = None
    covariance: Array | None = None


LOST = Estimate("lost", 0.0)


def weighted_estimate(translations: Array, orientations: Array, weights: Array) -> Estimate:
    """The expected pose (equations 18 and 19; the rotation after Markley) of (P, 3), (P, 4)."""
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
