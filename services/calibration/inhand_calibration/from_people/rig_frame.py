"""The rig's frame: z up from the floor, as seen from the reference camera."""

import numpy as np

from inhand_calibration.arrays import Array
from inhand_calibration.floor import Floor, frame_on
from inhand_calibration.from_people.estimate import CameraEstimate


def floor_frame(floor: Floor | None, origin: Array | None = None) -> CameraEstimate:
    """Return rig_from_reference, by a floor in the reference camera's frame.

    The origin is on the floor below the camera, or below a point ``origin`` (3,) of its frame; x
    goes the way that the camera looks, or, where it looks down, the way that is up in its image.
    Without a floor the axes are the camera's.
    """
    point = np.zeros(3) if origin is None else np.asarray(origin, float)
    if floor is None:
        return CameraEstimate(np.eye(3), -point)
    frame = frame_on(floor, point)
    return CameraEstimate(frame[:3, :3], frame[:3, 3])


def frame_in_words(reference: str, floor: Floor | None, origin: Array | None) -> str:
    """Return where the rig's frame has its origin and its axes, in words."""
    place = reference if origin is None else "the point that was given"
    if floor is None:
        return f"axes as {reference}'s (x right, y down, z forward), origin in {place}"
    return f"z up, x the way {reference} looks, origin on the floor below {place}"
