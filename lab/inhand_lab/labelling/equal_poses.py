"""Poses that look the same, because of an object's symmetries."""

from collections.abc import Sequence

import numpy as np
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.shape.shape import Symmetry

Pose = tuple[Array, Array]
"""A translation (3,) in metres and a rotation (4,)."""


def nearest_equal(pose: Pose, last: Pose, symmetries: Sequence[Symmetry]) -> Pose:
    """Return the pose that looks the same as ``pose`` and is turned least from ``last``.

    It is one of the products of the discrete symmetries, then any turn about the axis of a
    continuous one. Both poses are in one frame.
    """
    equal = [pose]
    for symmetry in symmetries:
        turns = [2.0 * np.pi * step / symmetry.order for step in range(symmetry.order)] or [0.0]
        equal = [turned(one, symmetry, turn) for one in equal for turn in turns]
    for symmetry in symmetries:
        if symmetry.order == 0:
            equal += [turned(one, symmetry, _best_turn(one, last, symmetry)) for one in equal]
    angles = [float(rotations.angle_between(last[1], rotation)) for _, rotation in equal]
    return equal[int(np.argmin(angles))]


def turned(pose: Pose, symmetry: Symmetry, angle: float) -> Pose:
    """Turn an object at a pose about the axis of a symmetry, by an angle in radians."""
    translation, rotation = pose
    centre = np.array(symmetry.centre)
    after = rotations.multiply(rotation, rotations.from_vector(angle * _axis(symmetry)))
    moved = rotations.rotate(rotation, centre) - rotations.rotate(after, centre)
    return translation + moved, after


def _best_turn(pose: Pose, last: Pose, symmetry: Symmetry) -> float:
    """Return the angle about the axis that leaves the least turn from the last pose.

    The half turn's cosine that is left after a turn φ is w cos(φ/2) − (v·a) sin(φ/2).
    """
    between = rotations.multiply(rotations.conjugate(last[1]), pose[1])
    return float(2.0 * np.arctan2(-(between[1:] @ _axis(symmetry)), between[0]))


def _axis(symmetry: Symmetry) -> Array:
    axis = np.array(symmetry.axis)
    return np.asarray(axis / np.linalg.norm(axis))
