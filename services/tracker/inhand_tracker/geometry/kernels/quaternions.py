"""Rotations one by one: unit quaternions (w, x, y, z) and vectors as tuples of numbers.

Everything here is compiled into its callers. ``geometry/rotations`` has the same on arrays.
"""

from typing import TypeAlias

import numpy as np
from inhand_runtime.compiled import njit

from inhand_tracker.geometry.arrays import Array

Vector: TypeAlias = tuple[float, float, float]
Quaternion: TypeAlias = tuple[float, float, float, float]


@njit(cache=True, nogil=True, inline="always")
def vector_in(array: Array) -> Vector:
    """Read three numbers (3,)."""
    return array[0], array[1], array[2]


@njit(cache=True, nogil=True, inline="always")
def quaternion_in(array: Array) -> Quaternion:
    """Read four numbers (4,)."""
    return array[0], array[1], array[2], array[3]


@njit(cache=True, nogil=True, inline="always")
def set_quaternion(array: Array, quaternion: Quaternion) -> None:
    """Write a quaternion into an array (4,)."""
    array[0], array[1], array[2], array[3] = quaternion


@njit(cache=True, nogil=True, inline="always")
def set_matrix(array: Array, quaternion: Quaternion) -> None:
    """Write the rotation matrix of a quaternion into an array (3, 3)."""
    w, x, y, z = quaternion
    array[0, 0], array[1, 1] = 1.0 - 2.0 * (y * y + z * z), 1.0 - 2.0 * (x * x + z * z)
    array[2, 2] = 1.0 - 2.0 * (x * x + y * y)
    array[0, 1], array[1, 0] = 2.0 * (x * y - w * z), 2.0 * (x * y + w * z)
    array[0, 2], array[2, 0] = 2.0 * (x * z + w * y), 2.0 * (x * z - w * y)
    array[1, 2], array[2, 1] = 2.0 * (y * z - w * x), 2.0 * (y * z + w * x)


@njit(cache=True, nogil=True, inline="always")
def product(first: Quaternion, second: Quaternion) -> Quaternion:
    """Chain rotations: ``second`` followed by ``first``."""
    w, x, y, z = first
    a, b, c, d = second
    return (
        w * a - x * b - y * c - z * d,
        w * b + x * a + y * d - z * c,
        w * c - x * d + y * a + z * b,
        w * d + x * c - y * b + z * a,
    )


@njit(cache=True, nogil=True, inline="always")
def inverse(quaternion: Quaternion) -> Quaternion:
    """Invert a rotation."""
    return quaternion[0], -quaternion[1], -quaternion[2], -quaternion[3]


@njit(cache=True, nogil=True, inline="always")
def turned(quaternion: Quaternion, vector: Vector) -> Vector:
    """Turn a vector."""
    w, x, y, z = quaternion
    a, b, c = vector
    # Twice the cross product of axis and vector.
    u, v, s = 2.0 * (y * c - z * b), 2.0 * (z * a - x * c), 2.0 * (x * b - y * a)
    return a + w * u + y * s - z * v, b + w * v + z * u - x * s, c + w * s + x * v - y * u


@njit(cache=True, nogil=True, inline="always")
def quaternion_of(vector: Vector) -> Quaternion:
    """Find the quaternion of a rotation vector, in radians."""
    angle = np.sqrt(vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2])
    scale = 0.5 if angle < 1e-12 else np.sin(0.5 * angle) / angle
    return np.cos(0.5 * angle), scale * vector[0], scale * vector[1], scale * vector[2]


@njit(cache=True, nogil=True, inline="always")
def vector_of(quaternion: Quaternion) -> Vector:
    """Find the rotation vector of a quaternion, in radians, no longer than π."""
    w, x, y, z = quaternion
    sine = np.sqrt(x * x + y * y + z * z)
    scale = 2.0 * np.arctan2(sine, abs(w)) / sine if sine > 1e-12 else 2.0
    scale = -scale if w < 0.0 else scale
    return scale * x, scale * y, scale * z


@njit(cache=True, nogil=True, inline="always")
def quaternion_of_matrix(matrix: Array) -> Quaternion:
    """Find the quaternion of a rotation matrix (3, 3), by its largest component."""
    a, b, c = matrix[0, 0], matrix[1, 1], matrix[2, 2]
    trace = a + b + c
    x = matrix[2, 1] - matrix[1, 2]
    y = matrix[0, 2] - matrix[2, 0]
    z = matrix[1, 0] - matrix[0, 1]
    xy, xz, yz = (
        matrix[0, 1] + matrix[1, 0],
        matrix[0, 2] + matrix[2, 0],
        matrix[1, 2] + matrix[2, 1],
    )
    if trace >= max(2.0 * a - trace, 2.0 * b - trace, 2.0 * c - trace):
        found = (1.0 + trace, x, y, z)
    elif a >= b and a >= c:
        found = (x, 1.0 + 2.0 * a - trace, xy, xz)
    elif b >= c:
        found = (y, xy, 1.0 + 2.0 * b - trace, yz)
    else:
        found = (z, xz, yz, 1.0 + 2.0 * c - trace)
    w, i, j, k = found
    length = np.sqrt(w * w + i * i + j * j + k * k)
    return w / length, i / length, j / length, k / length
