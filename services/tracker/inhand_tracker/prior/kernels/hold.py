"""How an object is held by one body, and what lies between two predictions."""

import numpy as np
from inhand_runtime.compiled import vectorised

from inhand_tracker.body.kernels.holders import set_holder
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.kernels.nearest_rotation import nearest_rotation
from inhand_tracker.geometry.kernels.pose_normals import set_turned_blocks
from inhand_tracker.geometry.kernels.quaternions import (
    inverse,
    product,
    quaternion_of,
    quaternion_of_matrix,
    set_matrix,
    vector_of,
)


@vectorised("(a,v),(a,v,v),(),(),(v),(v,v),(i,i),()->(v),(v,v),(i,i)")
def held(
    origins: Array,
    axes: Array,
    holder: float,
    hands_together_m: float,
    place: Array,
    turn: Array,
    spread: Array,
    height: float,
    centre: Array,
    rotation: Array,
    covariance: Array,
) -> None:
    """Fill the pose and covariance, in the camera frame and metres, of an object with ``place``
    (3,), ``turn`` (3, 3) and covariance ``spread`` (6, 6) in a holder, in body heights."""
    own = np.empty((3, 3))
    set_holder(origins, axes, np.int64(holder), hands_together_m, centre, own)
    turned = np.zeros((3, 3))
    for row in range(3):
        for k in range(3):
            centre[row] += height * own[row, k] * place[k]
            for column in range(3):
                turned[row, column] += own[row, k] * turn[k, column]
    nearest_rotation(turned, rotation)
    scaled = spread.copy()
    scaled[:3] *= height
    scaled[:, :3] *= height
    set_turned_blocks(scaled, own, covariance)


@vectorised("(v),(v,v),(i,i),(v),(v,v),(i,i),(),()->(v),(v,v),(i,i)")
def between(
    one_centre: Array,
    one_rotation: Array,
    one_covariance: Array,
    other_centre: Array,
    other_rotation: Array,
    other_covariance: Array,
    share: float,
    doubt: float,
    centre: Array,
    rotation: Array,
    covariance: Array,
) -> None:
    """Fill the pose and covariance that lie a ``share`` of the way from one prediction to another,
    as ``prediction.between`` says."""
    start = quaternion_of_matrix(one_rotation)
    turned = vector_of(product(quaternion_of_matrix(other_rotation), inverse(start)))
    step = quaternion_of((share * turned[0], share * turned[1], share * turned[2]))
    set_matrix(rotation, product(step, start))
    unsure = share * (1.0 - share) + share * doubt
    moves, turns = 0.0, 0.0
    for axis in range(3):
        moved = other_centre[axis] - one_centre[axis]
        centre[axis] = one_centre[axis] + share * moved
        moves += moved * moved
        turns += turned[axis] * turned[axis]
    covariance[:] = (1.0 - share) * one_covariance + share * other_covariance
    for axis in range(3):
        covariance[axis, axis] += unsure * moves
        covariance[3 + axis, 3 + axis] += unsure * turns
