"""Where a convention's joints lie in a body, and joints that are moved from one to another.

Everything stands on joints that all sources measure. Shoulders, hips, wrists and ankles give the
directions of trunk and limbs, and stay. What is missing (NaN) is neither measured nor moved.
"""

import numpy as np
from inhand_runtime.compiled import njit, vectorised
from inhand_schemas.joints import Joint

from inhand_tracker.body.kernels.axes import (
    ANKLES,
    CHEST,
    ELBOWS,
    HANDS,
    HEAD,
    HIP_LEFT,
    HIP_RIGHT,
    HIPS,
    KNEES,
    SHOULDERS,
    SPINE,
    WRISTS,
)
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.kernels.quaternions import Vector, vector_in
from inhand_tracker.geometry.kernels.vectors import blended, cross, dot, minus, set_vector, unit

PAIR = (HIP_RIGHT, HIP_LEFT)
FEET = (int(Joint.FOOT_RIGHT), int(Joint.FOOT_LEFT))
HIP_CENTRE_UP, SPINE_UP, SPINE_AHEAD, CHEST_UP, SHOULDERS_UP, SHOULDERS_ASIDE, HIPS_ASIDE = range(7)
NECK, FOREARM, HAND, THIGH, FOOT = range(7, 12)
LIMBS = (
    (WRISTS, ELBOWS, FOREARM),
    (WRISTS, HANDS, HAND),
    (PAIR, KNEES, THIGH),
    (ANKLES, FEET, FOOT),
)
"""Joints that keep their place, those that are moved along the limb from them, and the length."""


@njit(cache=True, nogil=True, inline="always")
def _middle(joints: Array, pair: tuple[int, int]) -> Vector:
    first, second = vector_in(joints[pair[0]]), vector_in(joints[pair[1]])
    return (
        0.5 * (first[0] + second[0]),
        0.5 * (first[1] + second[1]),
        0.5 * (first[2] + second[2]),
    )


@njit(cache=True, nogil=True, inline="always")
def _trunk(joints: Array, origin: Vector) -> tuple[Vector, Vector, Vector]:
    """Find left, up and forwards by shoulders and hips alone; ``origin`` is between the hips."""
    up = unit(minus(_middle(joints, SHOULDERS), origin))
    shoulders = unit(minus(vector_in(joints[SHOULDERS[1]]), vector_in(joints[SHOULDERS[0]])))
    hips = unit(minus(vector_in(joints[HIP_LEFT]), vector_in(joints[HIP_RIGHT])))
    left = blended(shoulders, 1.0, hips)
    left = unit(blended(left, -dot(left, up), up))
    return left, up, cross(left, up)


@njit(cache=True, nogil=True, inline="always")
def _length(vector: Vector) -> float:
    return float(np.sqrt(dot(vector, vector)))


@njit(cache=True, nogil=True, inline="always")
def _hangs(joints: Array, up: Vector, limbs: tuple[tuple[int, int], tuple[int, int]]) -> float:
    """Find the least cosine between downwards and the limbs from two joints to two others."""
    upper, lower = limbs
    right = unit(minus(vector_in(joints[upper[0]]), vector_in(joints[lower[0]])))
    left = unit(minus(vector_in(joints[upper[1]]), vector_in(joints[lower[1]])))
    return min(dot(right, up), dot(left, up))


@vectorised("(j,v),(),(),(m)->(m)")
def measure(joints: Array, height: float, straight: float, twelve: Array, measures: Array) -> None:
    """Measure one body (20, 3) in body heights; the trunk only where it is stood upright.

    Upright is where thighs and upper arms hang within an angle of the cosine ``straight`` below the
    trunk: who leans, bends, sits or reaches up shows a posture and no convention. NaN otherwise.
    """
    measures[:] = np.nan
    for limb in LIMBS:
        length = 0.0
        for side in range(2):
            length += _length(
                minus(vector_in(joints[limb[1][side]]), vector_in(joints[limb[0][side]]))
            )
        measures[limb[2]] = 0.5 * length / height
    measures[NECK] = _length(minus(vector_in(joints[HEAD]), vector_in(joints[CHEST]))) / height
    origin = _middle(joints, PAIR)
    left, up, forwards = _trunk(joints, origin)
    upright = min(_hangs(joints, up, (PAIR, KNEES)), _hangs(joints, up, (SHOULDERS, ELBOWS)))
    if not upright > straight:
        return
    spine = minus(vector_in(joints[SPINE]), origin)
    shoulders = minus(vector_in(joints[SHOULDERS[1]]), vector_in(joints[SHOULDERS[0]]))
    hips = minus(vector_in(joints[HIP_LEFT]), vector_in(joints[HIP_RIGHT]))
    measures[HIP_CENTRE_UP] = dot(minus(vector_in(joints[HIPS]), origin), up) / height
    measures[SPINE_UP], measures[SPINE_AHEAD] = (
        dot(spine, up) / height,
        dot(spine, forwards) / height,
    )
    measures[CHEST_UP] = dot(minus(vector_in(joints[CHEST]), origin), up) / height
    measures[SHOULDERS_UP] = dot(minus(_middle(joints, SHOULDERS), origin), up) / height
    measures[SHOULDERS_ASIDE] = 0.5 * dot(shoulders, left) / height
    measures[HIPS_ASIDE] = 0.5 * dot(hips, left) / height


@njit(cache=True, nogil=True, inline="always")
def _push(moved: Array, joint: int, way: float, direction: Vector) -> None:
    """Move a joint, unless the way or the joint is unknown."""
    to = blended(vector_in(moved[joint]), way, direction)
    if np.isfinite(to[0] + to[1] + to[2]):
        set_vector(moved[joint], to)


@vectorised("(j,v),(m),()->(j,v)")
def move(joints: Array, differences: Array, height: float, moved: Array) -> None:
    """Move the joints of a body (20, 3) by ``differences`` of its measures, in body heights.

    Shoulders and hips stay, wherever they lie: a shoulder that is raised turns the front of a
    forearm that hangs, and what it holds.
    """
    moved[:] = joints
    for limb in LIMBS:
        for side in range(2):
            root, end = vector_in(joints[limb[0][side]]), vector_in(joints[limb[1][side]])
            _push(moved, limb[1][side], height * differences[limb[2]], unit(minus(end, root)))
    _, up, forwards = _trunk(joints, _middle(joints, PAIR))
    neck = unit(minus(vector_in(joints[HEAD]), vector_in(joints[CHEST])))
    _push(moved, HIPS, height * differences[HIP_CENTRE_UP], up)
    _push(moved, SPINE, height * differences[SPINE_UP], up)
    _push(moved, SPINE, height * differences[SPINE_AHEAD], forwards)
    _push(moved, CHEST, height * differences[CHEST_UP], up)
    _push(moved, HEAD, height * differences[CHEST_UP], up)
    _push(moved, HEAD, height * differences[NECK], neck)
