"""Tells bodies from their mirror images by what points forwards in them."""

import numpy as np
from inhand_schemas.joints import Joint
from inhand_tracker.geometry.arrays import Array

from inhand_lab.datasets.parameters import DEFAULT_DATASET


def foot_directions(joints: Array) -> Array:
    """Return where feet point, (N, 3), of bodies (N, 20, 3); NaN where a foot is missing."""
    feet = (Joint.FOOT_LEFT, Joint.FOOT_RIGHT)
    return np.mean([joints[:, foot] - joints[:, foot - 1] for foot in feet], axis=0)


def pointing_forwards(joints: Array, directions: Array) -> Array:
    """Return how far directions (N, 3) point forwards of the hips of bodies (N, 20, 3).

    It is in the median length of the directions, of those bodies alone that show it.
    """
    hips = joints[:, Joint.HIP_LEFT] - joints[:, Joint.HIP_RIGHT]
    upwards = joints[:, Joint.SHOULDER_CENTER] - joints[:, Joint.HIP_CENTER]
    forwards = np.cross(hips, upwards)
    seen = np.isfinite(directions).all(axis=1) & (np.linalg.norm(forwards, axis=1) > 0.0)
    seen &= np.linalg.norm(directions, axis=1) > 0.0
    if not seen.any():
        return np.zeros(0)
    directions, forwards = directions[seen], forwards[seen]
    forwards /= np.linalg.norm(forwards, axis=1, keepdims=True)
    length = np.median(np.linalg.norm(directions, axis=1))
    return np.sum(directions * forwards, axis=1) / length


def is_mirror_image(pointing: Array) -> bool:
    """Whether what ``pointing_forwards`` gives is a mirror image's."""
    return bool(len(pointing)) and bool(np.median(pointing) < DEFAULT_DATASET.backward_feet)
