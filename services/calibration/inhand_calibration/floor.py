"""The floor, and the frame that stands on it."""

from dataclasses import dataclass

import numpy as np

from inhand_calibration.arrays import Array
from inhand_calibration.rigid import rigid

_FORWARD, _IMAGE_UP = np.array([0.0, 0.0, 1.0]), np.array([0.0, -1.0, 0.0])
_LEAST_LEVEL = 0.2
"""Share of the way that a camera looks that must be level for x to follow it."""


@dataclass(frozen=True)
class Floor:
    """The plane {p: up · p = height} in the reference camera's frame, with deviations.

    ``tilt_deviation`` is that of up, radians, and ``height_deviation`` that of the height, metres,
    where it was seen.
    """

    up: Array
    height: float
    tilt_deviation: float
    height_deviation: float


def frame_on(floor: Floor, point: Array) -> Array:
    """Return rig_from_reference (4, 4) of a frame whose z is up, with its origin on the floor below
    a point (3,) of the reference camera's frame.

    x goes the way that the camera looks, or, where it looks down, the way that is up in its image.
    """
    level = _FORWARD - (_FORWARD @ floor.up) * floor.up
    if np.linalg.norm(level) < _LEAST_LEVEL:
        level = _IMAGE_UP - (_IMAGE_UP @ floor.up) * floor.up
    x = level / np.linalg.norm(level)
    rotation = np.stack([x, np.cross(floor.up, x), floor.up])
    below = point - (point @ floor.up - floor.height) * floor.up
    return rigid(rotation, -rotation @ below)
