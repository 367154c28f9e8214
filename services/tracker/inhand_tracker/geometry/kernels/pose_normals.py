"""Normal distributions over poses: deviations from a mean, densities, draws.

A deviation (6,) is a translation and a rotation vector on the left.
"""

import numpy as np
from inhand_runtime.compiled import njit, vectorised

from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.geometry.kernels.matrices import find_root, invert, solve_lower
from inhand_tracker.geometry.kernels.quaternions import (
    inverse,
    product,
    quaternion_in,
    quaternion_of,
    set_quaternion,
    vector_in,
    vector_of,
)
from inhand_tracker.geometry.kernels.vectors import set_vector

LOG_TURNS = 3.0 * np.log(2.0 * np.pi)
"""Logarithm of a standard normal distribution's scale in six dimensions."""


@njit(cache=True, nogil=True, inline="always")
def set_deviation(
    centre: Array, rotation: Array, pose_centre: Array, pose_rotation: Array, deviation: Array
) -> None:
    """Fill ``deviation`` (6,) with that of a pose from a mean."""
    turn = product(quaternion_in(pose_rotation), inverse(quaternion_in(rotation)))
    for axis in range(3):
        deviation[axis] = pose_centre[axis] - centre[axis]
    set_vector(deviation[3:], vector_of(turn))


@njit(cache=True, nogil=True, inline="always")
def set_deviated(
    centre: Array, rotation: Array, deviation: Array, pose_centre: Array, pose_rotation: Array
) -> None:
    """Fill a pose, (3,) and (4,), by its deviation (6,) from a mean."""
    for axis in range(3):
        pose_centre[axis] = centre[axis] + deviation[axis]
    turn = quaternion_of(vector_in(deviation[3:]))
    set_quaternion(pose_rotation, product(turn, quaternion_in(rotation)))


@njit(cache=True, nogil=True, inline="always")
def _square_by(root: Array, deviation: Array) -> float:
    """Find the squared Mahalanobis distance of a deviation (6,), which is used up, by the root
    (6, 6) of a covariance."""
    solve_lower(root, deviation)
    square = 0.0
    for axis in range(6):
        square += deviation[axis] * deviation[axis]
    return square


@njit(cache=True, nogil=True)
def draw(
    parts: Indices, centres: Array, rotations: Array, roots: Array, normals: Array
) -> tuple[Array, Array]:
    """Return poses (P, 3) and (P, 4), of standard ``normals`` (P, 6) about the means of parts (P,),
    whose covariances have ``roots`` (K, 6, 6)."""
    drawn_centres, drawn_rotations = np.empty((len(parts), 3)), np.empty((len(parts), 4))
    deviation = np.empty(6)
    for pose in range(len(parts)):
        part = parts[pose]
        for row in range(6):
            deviation[row] = 0.0
            for column in range(row + 1):
                deviation[row] += roots[part, row, column] * normals[pose, column]
        set_deviated(
            centres[part], rotations[part], deviation, drawn_centres[pose], drawn_rotations[pose]
        )
    return drawn_centres, drawn_rotations


@vectorised("(v),(q),(v),(q),(s)->(s)")
def deviations(
    centre: Array,
    rotation: Array,
    pose_centre: Array,
    pose_rotation: Array,
    six: Array,
    deviation: Array,
) -> None:
    """Find deviations (6,) of poses from means."""
    set_deviation(centre, rotation, pose_centre, pose_rotation, deviation)


@vectorised("(s,s)->(s,s)")
def roots(matrix: Array, root: Array) -> None:
    """Find the triangular roots of matrices; NaN of one that is not positive definite."""
    root[:] = 0.0
    if not find_root(matrix, root):
        root[:] = np.nan


@vectorised("(s,s)->(s,s)")
def inverses(matrix: Array, inverse: Array) -> None:
    """Find the inverses of matrices; NaN of one that is not positive definite."""
    root = np.empty_like(matrix)
    if find_root(matrix, root):
        invert(root, inverse)
    else:
        inverse[:] = np.nan


@vectorised("(v),(q),(s,s),(v),(q)->()")
def squares_by_information(
    centre: Array,
    rotation: Array,
    information: Array,
    pose_centre: Array,
    pose_rotation: Array,
    square: Array,
) -> None:
    """Find the squared Mahalanobis distances of poses by ``information`` (6, 6)."""
    deviation = np.empty(6)
    set_deviation(centre, rotation, pose_centre, pose_rotation, deviation)
    total = 0.0
    for row in range(6):
        for column in range(6):
            total += deviation[row] * information[row, column] * deviation[column]
    square[0] = total


@vectorised("(v),(q),(s,s),(v),(q)->()")
def square_distances(
    centre: Array,
    rotation: Array,
    root: Array,
    pose_centre: Array,
    pose_rotation: Array,
    square: Array,
) -> None:
    """Find the squared Mahalanobis distances of poses by roots (6, 6) of covariances."""
    deviation = np.empty(6)
    set_deviation(centre, rotation, pose_centre, pose_rotation, deviation)
    square[0] = _square_by(root, deviation)


@vectorised("(k),(k,v),(k,q),(k,s,s),(p,v),(p,q)->(k,p)")
def log_densities(
    weights: Array,
    centres: Array,
    rotations: Array,
    roots: Array,
    pose_centres: Array,
    pose_rotations: Array,
    densities: Array,
) -> None:
    """Find the log-densities (K, P) of poses, (P, 3) and (P, 4), by parts of means (K, 3) and
    (K, 4) and of covariances with ``roots`` (K, 6, 6), each times its weight (K,)."""
    deviation = np.empty(6)
    for part in range(len(weights)):
        root = roots[part]
        scale = np.log(weights[part]) - LOG_TURNS
        for axis in range(6):
            scale -= np.log(root[axis, axis])
        for pose in range(len(pose_centres)):
            set_deviation(
                centres[part], rotations[part], pose_centres[pose], pose_rotations[pose], deviation
            )
            densities[part, pose] = scale - 0.5 * _square_by(root, deviation)


@njit(cache=True, nogil=True)
def set_turned_blocks(matrix: Array, turn: Array, turned: Array) -> None:
    """Fill ``turned`` (6, 6) as ``turn_blocks`` does."""
    half = np.empty((6, 6))
    for row in range(6):
        first = 3 * (row // 3)
        for column in range(6):
            half[row, column] = 0.0
            for k in range(3):
                half[row, column] += turn[row - first, k] * matrix[first + k, column]
    for row in range(6):
        for column in range(6):
            first = 3 * (column // 3)
            turned[row, column] = 0.0
            for k in range(3):
                turned[row, column] += half[row, first + k] * turn[column - first, k]


@vectorised("(s,s),(v,v)->(s,s)")
def turn_blocks(matrix: Array, turn: Array, turned: Array) -> None:
    """Rotate both kinds of deviations that a matrix (6, 6) is of: T M Tᵀ, T of two (3, 3)."""
    set_turned_blocks(matrix, turn, turned)


@vectorised("(p,s),(s,s),(),()->()")
def share_near(normals: Array, root: Array, near_m: float, near_rad: float, share: Array) -> None:
    """Find the share of standard ``normals`` (P, 6) that a covariance's root takes to deviations
    of less than some metres and radians."""
    near = 0
    for index in range(len(normals)):
        moved, turned = 0.0, 0.0
        for row in range(6):
            value = 0.0
            for column in range(row + 1):
                value += root[row, column] * normals[index, column]
            if row < 3:
                moved += value * value
            else:
                turned += value * value
        if moved < near_m * near_m and turned < near_rad * near_rad:
            near += 1
    share[0] = near / len(normals)


@vectorised("(p,v),(p,q),(),()->(p)")
def each_once(
    centres: Array, rotations: Array, near_m: float, near_rad: float, chosen: Array
) -> None:
    """Choose, by a 1 in ``chosen`` (P,), poses (P, 3) and (P, 4) of which none is within some
    metres and radians of one that was chosen before."""
    deviation = np.empty(6)
    for pose in range(len(centres)):
        chosen[pose] = 1.0
        for other in range(pose):
            if chosen[other] == 0.0:
                continue
            set_deviation(
                centres[other], rotations[other], centres[pose], rotations[pose], deviation
            )
            moved, turned = 0.0, 0.0
            for axis in range(3):
                moved += deviation[axis] ** 2
                turned += deviation[3 + axis] ** 2
            if moved < near_m**2 and turned < near_rad**2:
                chosen[pose] = 0.0
                break


@vectorised("(s,s),(v)->(s,s)")
def moved_covariance(covariance: Array, arm: Array, moved: Array) -> None:
    """Find L C Lᵀ, where L takes deviations of a pose to those of a point at ``arm`` (3,)."""
    x, y, z = vector_in(arm)
    half = np.empty((6, 6))
    for column in range(6):
        a, b, c = covariance[3, column], covariance[4, column], covariance[5, column]
        half[0, column] = covariance[0, column] + b * z - c * y
        half[1, column] = covariance[1, column] - a * z + c * x
        half[2, column] = covariance[2, column] + a * y - b * x
        half[3, column], half[4, column], half[5, column] = a, b, c
    for row in range(6):
        a, b, c = half[row, 3], half[row, 4], half[row, 5]
        moved[row, 0] = half[row, 0] + b * z - c * y
        moved[row, 1] = half[row, 1] - a * z + c * x
        moved[row, 2] = half[row, 2] + a * y - b * x
        moved[row, 3], moved[row, 4], moved[row, 5] = a, b, c


@vectorised("(s,s),(v)->(s,s)")
def moved_information(information: Array, arm: Array, moved: Array) -> None:
    """Find Lᵀ I L, where L takes deviations of a pose to those of a point at ``arm`` (3,)."""
    x, y, z = vector_in(arm)
    half = np.empty((6, 6))
    for row in range(6):
        a, b, c = information[row, 0], information[row, 1], information[row, 2]
        half[row, 0], half[row, 1], half[row, 2] = a, b, c
        half[row, 3] = information[row, 3] - b * z + c * y
        half[row, 4] = information[row, 4] + a * z - c * x
        half[row, 5] = information[row, 5] - a * y + b * x
    for column in range(6):
        a, b, c = half[0, column], half[1, column], half[2, column]
        moved[0, column], moved[1, column], moved[2, column] = a, b, c
        moved[3, column] = half[3, column] - b * z + c * y
        moved[4, column] = half[4, column] + a * z - c * x
        moved[5, column] = half[5, column] - a * y + b * x
