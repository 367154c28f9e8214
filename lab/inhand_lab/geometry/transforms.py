"""Rigid transforms over time, as translations and rotation matrices.

All the lab's matrices of rotations are made here, by scipy. Whatever is computed on quaternions is
in the tracker's geometry/rotations.py; here they are only what labels are written in.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array, Flags
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

MIRROR = np.array([-1.0, 1.0, 1.0])
"""Reflection in the plane x = 0, as the diagonal of its matrix."""


@dataclass(frozen=True)
class Transform:
    """A rigid transform a_from_b, or a series of them.

    ``translation`` (..., 3) is in metres, ``rotation`` (..., 3, 3); leading axes broadcast.
    """

    translation: Array
    rotation: Array

    def __matmul__(self, other: Transform) -> Transform:
        """The chain a_from_b @ b_from_c = a_from_c."""
        return Transform(self.apply(other.translation), self.rotation @ other.rotation)

    def apply(self, points: ArrayLike) -> Array:
        """Points (..., 3) of b, one for each transform, as points of a."""
        rotated = np.einsum("...ij,...j->...i", self.rotation, np.asarray(points, float))
        return np.asarray(rotated + self.translation)

    def inverse(self) -> Transform:
        """The inverse b_from_a."""
        transposed = np.swapaxes(self.rotation, -1, -2)
        return Transform(-np.einsum("...ij,...j->...i", transposed, self.translation), transposed)

    def mirrored(self) -> Transform:
        """The transform between the two frames once both are reflected in their plane x = 0."""
        return Transform(self.translation * MIRROR, self.rotation * np.outer(MIRROR, MIRROR))

    def repeated(self, count: int) -> Transform:
        """A single transform as a constant series (count, ...)."""
        return Transform(
            np.broadcast_to(self.translation, (count, 3)).copy(),
            np.broadcast_to(self.rotation, (count, 3, 3)).copy(),
        )

    def __getitem__(self, index: int | slice | Flags) -> Transform:
        return Transform(self.translation[index], self.rotation[index])


def rotation_about(axes: str, *angles: ArrayLike) -> Array:
    """Rotations (..., 3, 3) by extrinsic Euler angles in radians, about axes named as scipy's."""
    stacked = np.stack(np.broadcast_arrays(*[np.asarray(angle, float) for angle in angles]), -1)
    matrices = Rotation.from_euler(axes, stacked.reshape(-1, len(axes))).as_matrix()
    return np.asarray(matrices.reshape(*stacked.shape[:-1], 3, 3))


def rotation_from_vector(vectors: ArrayLike) -> Array:
    """Rotations (..., 3, 3) by rotation vectors (..., 3) in radians."""
    array = np.asarray(vectors, float)
    matrices = Rotation.from_rotvec(array.reshape(-1, 3)).as_matrix()
    return np.asarray(matrices.reshape(*array.shape, 3))


def turn_points(points: Array, vectors: Array) -> Array:
    """Points (N, 3), each turned about the origin by a rotation vector (N, 3) in radians."""
    return np.asarray(Rotation.from_rotvec(vectors).apply(points))


def mean_rotation(rotations: Array) -> Array:
    """The rotation (3, 3) in the middle of rotations (T, 3, 3)."""
    return np.asarray(Rotation.from_matrix(rotations).mean().as_matrix())


def normalised(vectors: ArrayLike) -> Array:
    """Vectors (..., 3) scaled to unit length."""
    array = np.asarray(vectors, float)
    return np.asarray(array / np.linalg.norm(array, axis=-1, keepdims=True))


def rotation_from_axes(y: ArrayLike, towards_z: ArrayLike) -> Array:
    """Rotations (..., 3, 3) whose y axis is ``y`` and whose z axis leans to ``towards_z``.

    Both arguments are (..., 3), of any length but zero, and not parallel.
    """
    y_axis = normalised(y)
    x_axis = normalised(np.cross(y_axis, np.asarray(towards_z, float)))
    return np.stack(np.broadcast_arrays(x_axis, y_axis, np.cross(x_axis, y_axis)), axis=-1)


def interpolate(first: Transform, second: Transform, share: Array) -> Transform:
    """Transforms from first (share 0) to second (share 1), along a line and the shortest rotation.

    ``share`` is (T,), ``first`` and ``second`` are series (T, ...).
    """
    between = np.swapaxes(first.rotation, -1, -2) @ second.rotation
    turn = Rotation.from_matrix(between).as_rotvec() * share[:, None]
    return Transform(
        first.translation + share[:, None] * (second.translation - first.translation),
        first.rotation @ rotation_from_vector(turn),
    )


def quaternions(rotation: Array) -> Array:
    """Unit quaternions (T, 4), (w, x, y, z), of rotations (T, 3, 3), of continuous sign.

    The tracker's ``rotations.from_matrix`` differs in the last bit: scipy's conversion stays, so
    that the same version and seed make the same bytes.
    """
    unsigned = Rotation.from_matrix(rotation).as_quat(scalar_first=True)
    flips = np.sum(unsigned[1:] * unsigned[:-1], axis=1) < 0
    signs = np.where(np.cumsum(np.concatenate([[unsigned[0, 0] < 0], flips])) % 2 == 1, -1.0, 1.0)
    return np.asarray(unsigned * signs[:, None])
