"""How an object is held by one body, and what lies between two predictions."""

import numpy as np
from inhand_runtime.compiled import vectorised

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


@vectorised("(v),(v,v),(v),(v,v),(v),(v),(i,i),()->(v),(v,v),(i,i)")
def held(
    origin: Array,
    axes: Array,
    way: Array,
    turn: Array,
    grip: Array,
    pull: Array,
    spread: Array,
    growth: float,
    centre: Array,
    rotation: Array,
    covariance: Array,
) -> None:
    """Fill the pose, and its covariance in the camera frame, of an object that is held as
    ``hold.Hold`` says by a holder with an ``origin`` (3,), ``axes`` (3, 3) and a ``way`` (3,); the
    covariance is ``growth`` times ``spread`` (6, 6)."""
    turned = np.zeros((3, 3))
    for row in range(3):
        for column in range(3):
            turned[row, column] = way[row] * pull[column]
            for k in range(3):
                turned[row, column] += axes[row, k] * turn[k, column]
    nearest_rotation(turned, rotation)
    for row in range(3):
        centre[row] = origin[row]
        for k in range(3):
            centre[row] -= rotation[row, k] * grip[k]
    set_turned_blocks(growth * spread, rotation, covariance)


@vectorised("(v),(v,v),(i,i),(v),(v,v),(i,i),(),(),()->(v),(v,v),(i,i)")
def between(
    one_centre: Array,
    one_rotation: Array,
    one_covariance: Array,
    other_centre: Array,
    other_rotation: Array,
    other_covariance: Array,
    share: float,
    doubt: float,
    around: float,
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
    apart = np.empty(6)
    square = np.zeros(2)
    still = 1.0 - share + share * doubt
    apart_share = still * share * share + (1.0 - still) * (1.0 - share) * (1.0 - share)
    for axis in range(3):
        apart[axis], apart[3 + axis] = other_centre[axis] - one_centre[axis], turned[axis]
        centre[axis] = one_centre[axis] + share * apart[axis]
        square[0] += apart[axis] * apart[axis]
        square[1] += turned[axis] * turned[axis]
    for row in range(6):
        for column in range(6):
            covariance[row, column] = (
                still * one_covariance[row, column]
                + (1.0 - still) * other_covariance[row, column]
                + apart_share * apart[row] * apart[column]
            )
        covariance[row, row] += around * square[row // 3]
