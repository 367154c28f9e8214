"""Predictions: expected poses of an object, and what lies between two of them."""

from dataclasses import dataclass

import numpy as np

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.pose_gaussian import turn_blocks
from inhand_tracker.prior.kernels import hold as kernels


@dataclass(frozen=True)
class Prediction:
    """The expected pose of the object's centre, in the camera frame of right-handed people.

    ``centre`` (3,), ``rotation`` (3, 3), and ``covariance`` (6, 6) of (translation of the centre,
    rotation vector on the left).
    """

    centre: Array
    rotation: Array
    covariance: Array


def in_camera(covariance: Array, axes: Array, height: float) -> Array:
    """Take a covariance (6, 6) in axes (3, 3) and body heights to the camera frame and metres."""
    scale = np.array([height, height, height, 1.0, 1.0, 1.0])
    return turn_blocks(covariance * scale[:, None] * scale, axes)


def between(
    one: Prediction, other: Prediction, share: float, *, doubt: float = 0.0, around: float = 0.0
) -> Prediction:
    """Go a ``share``, from 0 to 1, of the way from one prediction to another.

    Both may be true, the one still with a probability of ``doubt`` at the other one: the covariance
    is that of both together. ``around`` times the square of what they differ by is added to it in
    every direction.
    """
    return Prediction(
        *kernels.between(
            one.centre,
            one.rotation,
            one.covariance,
            other.centre,
            other.rotation,
            other.covariance,
            share,
            doubt,
            around,
        )
    )
