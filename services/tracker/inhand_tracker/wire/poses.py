"""Rigid transforms as messages."""

import numpy as np
from inhand_schemas.messages import Pose

from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array


def pose_message(translation: Array, rotation: Array) -> Pose:
    """A transform as a message: (3,) and (4,)."""
    x, y, z = translation.tolist()
    a, b, c, d = rotations.normalise(rotation).tolist()
    return Pose((x, y, z), (a, b, c, d))


def compose(first: Pose, second: Pose) -> Pose:
    """``second``, then ``first``: rig_from_camera, camera_from_object → rig_from_object."""
    rotation = np.array(first.rotation)
    moved = rotations.rotate(rotation, np.array(second.translation)) + first.translation
    return pose_message(moved, rotations.multiply(rotation, np.array(second.rotation)))
