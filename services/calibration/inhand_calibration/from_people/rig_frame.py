"""The rig's frame: z up from the floor, as seen from the reference camera."""

import numpy as np

from inhand_calibration.arrays import Array
from inhand_calibration.from_people.estimate import CameraEstimate
from inhand_calibration.from_people.standing_floor import StandingFloor

_FORWARD, _IMAGE_UP = np.array([0.0, 0.0, 1.0]), np.array([0.0, -1.0, 0.0])
_LEAST_LEVEL = 0.2
"""Share of the way that a camera looks that must be level for x to follow it."""


def floor_frame(floor: StandingFloor | None, origin: Array | None = None) -> CameraEstimate:
    """Return rig_from_reference, by a floor in the reference camera's frame.

    The origin is on the floor below the camera, or below a point ``origin`` (3,) of its frame; x
    goes the way that the camera looks, or, where it looks down, the way that is up in its image.
    Without a floor the axes are the camera's.
    """
    point = np.zeros(3) if origin is None else np.asarray(origin, float)
    if floor is None:
        return CameraEstimate(np.eye(3), -point)
    level = _FORWARD - (_FORWARD @ floor.up) * floor.up
    if np.linalg.norm(level) < _LEAST_LEVEL:
        level = _IMAGE_UP - (_IMAGE_UP @ floor.up) * floor.up
    x = level / np.linalg.norm(level)
    rotation = np.stack([x, np.cross(floor.up, x), floor.up])
    below = point - (point @ floor.up - floor.height) * floor.up
    return CameraEstimate(rotation, -rotation @ below)


def frame_in_words(reference: str, floor: StandingFloor | None, origin: Array | None) -> str:
    """Return where the rig's frame has its origin and its axes, in words."""
    place = reference if origin is None else "the point that was given"
    if floor is None:
        return f"axes as {reference}'s (x right, y down, z forward), origin in {place}"
    return f"z up, x the way {reference} looks, origin on the floor below {place}"
