"""How a pose is moved and turned by hand: by steps, by numbers, by the handles about an object.

A frame is a Pose too: ``camera_from_frame``, whose axes are what steps go along.
"""

import numpy as np
from inhand_lab.labelling.equal_poses import Pose
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array

SAME_ROTATION = np.array([1.0, 0.0, 0.0, 0.0])


def composed(first: Pose, second: Pose) -> Pose:
    """Return the pose that a pose given in a frame has where the frame's own is ``first``."""
    return (
        first[0] + rotations.rotate(first[1], second[0]),
        rotations.normalise(rotations.multiply(first[1], second[1])),
    )


def inverse(pose: Pose) -> Pose:
    """Return the pose that undoes a pose."""
    back = rotations.conjugate(pose[1])
    return -rotations.rotate(back, pose[0]), back


def moved(pose: Pose, step: Array, axes: Array) -> Pose:
    """Move a pose by a step (3,) in metres along the axes of a frame with this rotation (4,)."""
    return pose[0] + rotations.rotate(axes, step), pose[1]


def turned(pose: Pose, turn: Array, axes: Array, about: Array) -> Pose:
    """Turn a pose by a rotation vector (3,) along the axes (4,), about a point (3,) of the camera
    frame."""
    rotation = rotations.from_vector(rotations.rotate(axes, turn))
    place = about + rotations.rotate(rotation, pose[0] - about)
    return place, rotations.normalise(rotations.multiply(rotation, pose[1]))


def dragged(pose: Pose, from_handles: Pose, to_handles: Pose) -> Pose:
    """Return where a pose goes when handles are dragged that it hangs on."""
    return composed(to_handles, composed(inverse(from_handles), pose))


def to_degrees(rotation: Array) -> Array:
    """Return the turns (3,) in degrees about the fixed axes x, then y, then z that make a
    rotation (4,)."""
    matrix = rotations.to_matrix(rotation)
    about_y = np.arctan2(-matrix[2, 0], np.hypot(matrix[0, 0], matrix[1, 0]))
    if np.hypot(matrix[0, 0], matrix[1, 0]) < 1e-9:  # x and z turn about one axis
        angles = [np.arctan2(-matrix[1, 2], matrix[1, 1]), about_y, 0.0]
    else:
        about_x = np.arctan2(matrix[2, 1], matrix[2, 2])
        angles = [about_x, about_y, np.arctan2(matrix[1, 0], matrix[0, 0])]
    return np.rad2deg(angles)


def from_degrees(turns: Array) -> Array:
    """Return the rotation (4,) of turns (3,) in degrees about the fixed axes x, y, z."""
    about = rotations.from_vector(np.diag(np.deg2rad(turns)))
    return np.asarray(rotations.multiply(about[2], rotations.multiply(about[1], about[0])))
