"""Coordinate systems of a body's joints (20, 3), by kernels; NaN where a joint is missing."""

import numpy as np
from inhand_runtime.compiled import njit, vectorised
from inhand_schemas.joints import JOINT_NAMES

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.kernels.quaternions import (
    Vector,
    quaternion_of_matrix,
    set_quaternion,
    vector_in,
)
from inhand_tracker.geometry.kernels.vectors import (
    blended,
    cross,
    dot,
    minus,
    set_columns,
    set_vector,
    unit,
)

HIPS, SPINE, CHEST, HEAD = (
    JOINT_NAMES.index(name) for name in ("HipCenter", "Spine", "ShoulderCenter", "Head")
)
HIP_LEFT, HIP_RIGHT = (JOINT_NAMES.index(name) for name in ("HipLeft", "HipRight"))
SHOULDERS, ELBOWS, WRISTS, HANDS, KNEES, ANKLES = (
    (JOINT_NAMES.index(f"{name}Right"), JOINT_NAMES.index(f"{name}Left"))
    for name in ("Shoulder", "Elbow", "Wrist", "Hand", "Knee", "Ankle")
)
RIGHT, LEFT = 0, 1
"""The sides in those pairs."""


@njit(cache=True, nogil=True)
def trunk_of(joints: Array) -> tuple[Vector, Vector, Vector]:
    """Find the trunk's left, up and forwards."""
    up = unit(minus(vector_in(joints[CHEST]), vector_in(joints[HIPS])))
    shoulders = unit(minus(vector_in(joints[SHOULDERS[LEFT]]), vector_in(joints[SHOULDERS[RIGHT]])))
    hips = unit(minus(vector_in(joints[HIP_LEFT]), vector_in(joints[HIP_RIGHT])))
    left = blended(shoulders, 1.0, hips)
    x = unit(blended(left, -dot(left, up), up))
    return x, up, cross(x, up)


@njit(cache=True, nogil=True)
def _set_forearm(axes: Array, joints: Array, side: int, up: Vector, straight_arm: float) -> None:
    """Set axes whose z is the forearm and whose y is turned to its front."""
    elbow, wrist = vector_in(joints[ELBOWS[side]]), vector_in(joints[WRISTS[side]])
    hand, shoulder = vector_in(joints[HANDS[side]]), vector_in(joints[SHOULDERS[side]])
    along = blended(minus(wrist, elbow), 0.5, minus(hand, wrist))
    _set_axes(axes, along, blended(minus(shoulder, elbow), straight_arm, up))


@njit(cache=True, nogil=True)
def _set_axes(axes: Array, along: Vector, towards: Vector) -> None:
    """Set columns with z along a direction and y as near to another as that allows."""
    z = unit(along)
    x = unit(cross(towards, z))
    set_columns(axes, x, cross(z, x), z)


@njit(cache=True, nogil=True, inline="always")
def _palm(joints: Array, side: int) -> Vector:
    return _middle(vector_in(joints[WRISTS[side]]), vector_in(joints[HANDS[side]]))


@njit(cache=True, nogil=True, inline="always")
def _middle(first: Vector, second: Vector) -> Vector:
    return (
        0.5 * (first[0] + second[0]),
        0.5 * (first[1] + second[1]),
        0.5 * (first[2] + second[2]),
    )


@njit(cache=True, nogil=True, inline="always")
def _direction(vector: Vector) -> Vector:
    """Scale a vector, however short, to length 1; NaN where it has no length."""
    length = np.sqrt(dot(vector, vector))
    return vector[0] / length, vector[1] / length, vector[2] / length


@vectorised("(j,v),(q)->(q)")
def pelvis_rotation(joints: Array, four: Array, quaternion: Array) -> None:
    """Find the pelvis' rotation (4,): x from the right hip to the left, y up, z forwards."""
    x = minus(vector_in(joints[HIP_LEFT]), vector_in(joints[HIP_RIGHT]))
    z = cross(x, minus(vector_in(joints[SPINE]), vector_in(joints[HIPS])))
    matrix = np.empty((3, 3))
    set_columns(matrix, _direction(x), _direction(cross(z, x)), _direction(z))
    set_quaternion(quaternion, quaternion_of_matrix(matrix))


@vectorised("(j,v)->()")
def pelvis_area(joints: Array, area: Array) -> None:
    """Find the area, in m², that the hips and the spine span; NaN where one of them is missing."""
    x = minus(vector_in(joints[HIP_LEFT]), vector_in(joints[HIP_RIGHT]))
    z = cross(x, minus(vector_in(joints[SPINE]), vector_in(joints[HIPS])))
    area[0] = np.sqrt(dot(z, z))


@vectorised("(j,v)->(v,v)")
def trunk(joints: Array, axes: Array) -> None:
    """Find the trunk's left, up and forwards, the columns of ``axes`` (3, 3)."""
    x, up, forwards = trunk_of(joints)
    set_columns(axes, x, up, forwards)


@vectorised("(j,v),(),(a)->(a,v),(a,v,v)")
def anchors(joints: Array, straight_arm: float, nine: Array, origins: Array, axes: Array) -> None:
    """Find the ``origins`` (A, 3) and ``axes`` (A, 3, 3) of ``anchors.ANCHORS``."""
    x, up, forwards = trunk_of(joints)
    hips, chest = vector_in(joints[HIPS]), vector_in(joints[CHEST])
    head = vector_in(joints[HEAD])
    set_vector(origins[0], _middle(hips, chest))
    set_columns(axes[0], x, up, forwards)
    set_vector(origins[1], head)
    _set_axes(axes[1], minus(head, chest), forwards)
    palms = _palm(joints, RIGHT), _palm(joints, LEFT)
    for side in range(2):
        hand, shank = 2 + 2 * side, 7 + side
        set_vector(origins[hand], palms[side])
        _set_forearm(axes[hand], joints, side, up, straight_arm)
        set_vector(origins[hand + 1], palms[side])
        set_columns(axes[hand + 1], x, up, forwards)
        ankle = vector_in(joints[ANKLES[side]])
        set_vector(origins[shank], ankle)
        _set_axes(axes[shank], minus(vector_in(joints[KNEES[side]]), ankle), forwards)
    set_vector(origins[6], _middle(palms[RIGHT], palms[LEFT]))
    _set_axes(axes[6], minus(palms[LEFT], palms[RIGHT]), up)
