"""Unit quaternions (w, x, y, z) on arrays of shape (..., 4).

SciPy's rotations do the same, and would cost the daemon a quarter of its memory.
"""

import numpy as np
from numpy.typing import ArrayLike

from inhand_outcomes.arrays import Array

_CONJUGATE = np.array([1.0, -1.0, -1.0, -1.0])


def matrices(quaternions: ArrayLike) -> Array:
    """Rotation matrices (..., 3, 3)."""
    w, x, y, z = np.moveaxis(np.asarray(quaternions, float), -1, 0)
    rows = (
        (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)),
        (2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)),
        (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)),
    )
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def multiply(first: Array, second: Array) -> Array:
    """The rotations (..., 4) ``second`` followed by ``first``, with w ≥ 0."""
    w1, v1, w2, v2 = first[..., :1], first[..., 1:], second[..., :1], second[..., 1:]
    w = w1 * w2 - np.sum(v1 * v2, axis=-1, keepdims=True)
    product = np.concatenate([w, w1 * v2 + w2 * v1 + np.cross(v1, v2)], axis=-1)
    return np.where(w < 0.0, -product, product)


def conjugate(quaternions: Array) -> Array:
    """The inverse rotations (..., 4)."""
    return quaternions * _CONJUGATE


def of_matrix(matrix: Array) -> Array:
    """The quaternion (4,) of a rotation matrix (3, 3), by its largest part."""
    trace = np.trace(matrix)
    squares = np.array([trace, *np.diagonal(matrix)])
    axis = int(squares.argmax())
    skew = np.array(
        [matrix[2, 1] - matrix[1, 2], matrix[0, 2] - matrix[2, 0], matrix[1, 0] - matrix[0, 1]]
    )
    if axis == 0:
        quaternion = np.concatenate([[1.0 + trace], skew])
    else:
        column = matrix[:, axis - 1] + matrix[axis - 1]
        column[axis - 1] = 1.0 + 2.0 * matrix[axis - 1, axis - 1] - trace
        quaternion = np.concatenate([[skew[axis - 1]], column])
    quaternion = quaternion / np.linalg.norm(quaternion)
    return np.where(quaternion[0] < 0.0, -quaternion, quaternion)


def rotation_vectors(quaternions: Array) -> Array:
    """Rotation vectors (..., 3), radians, of rotations with w ≥ 0."""
    sines = np.linalg.norm(quaternions[..., 1:], axis=-1, keepdims=True)
    angles = 2.0 * np.arctan2(sines, quaternions[..., :1])
    return quaternions[..., 1:] * np.where(sines > 1e-12, angles / np.maximum(sines, 1e-12), 2.0)
