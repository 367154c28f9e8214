"""Two bones and the joint between them: an arm's or a leg's."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.people.parameters import DEFAULT_LIMITS


@dataclass(frozen=True)
class JointCircle:
    """Where the middle joint of two bones may be: axis and centre (T, 3), radius (T,)."""

    axis: Array
    centre: Array
    radius: Array


def span(upper: float, lower: float, angle: float) -> float:
    """Distance between the ends of two bones of these lengths with this angle between them."""
    return float(np.sqrt(upper**2 + lower**2 - 2.0 * upper * lower * np.cos(angle)))


def bend_towards(
    root: Array, tip: Array, bones: tuple[float, float], extension: float
) -> tuple[JointCircle, Array]:
    """Where the middle joint of two bones from a root (T, 3) may be, and the tip (T, 3) reached.

    A tip out of reach is brought to the nearest distance that keeps the angle between the bones
    within the limit of flexion and ``extension``, radians.
    """
    upper, lower = bones
    offset = tip - root
    length = np.linalg.norm(offset, axis=1, keepdims=True)
    axis = offset / length
    nearest, furthest = (span(upper, lower, angle) for angle in (DEFAULT_LIMITS.flexion, extension))
    distance = np.clip(length, nearest, furthest)
    along = (upper**2 - lower**2 + distance**2) / (2.0 * distance)
    radius = np.sqrt(upper**2 - along[:, 0] ** 2)
    return JointCircle(axis, root + along * axis, radius), root + distance * axis
