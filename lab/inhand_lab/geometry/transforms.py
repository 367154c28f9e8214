"""Rigid transforms over time, mirrored and blended as arrays."""

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

    translation (..., 3) in metres and rotation (..., 3, 3); leading axes broadcast.
    """

    translation: Array
    rotation: Array

    def __matmul__(self, other: Transform) -> Transform:
        """a_from_b @ b_from_c = a_from_c."""
        return Transform(self.apply(other.translation), self.rotation @ other.rotation)

    def apply(self, points: ArrayLike) -> Array:
        """Points (..., 3) in b, one for each transform, to points in a."""
        rotated = np.einsum("...ij,...j->...i", self.rotation, np.asarray(points, float))
        return np.asarray(rotated + self.translation)

    def inverse(self) -> Transform:
        """b_from_a."""
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
    """Rotations (..., 3, 3) from extrinsic Euler angles in radians, named as scipy names them."""
    stacked = np.stack(np.broadcast_arrays(*[np.asarray(angle, float) for angle in angles]), -1)
    matrices = Rotation.from_euler(axes, stacked.reshape(-1, len(axes))).as_matrix()
    return np.asarray(matrices.reshape(*stacked.shape[:-1], 3, 3))


def normalised(vectors: ArrayLike) -> Array:
    """Vectors (..., 3) scaled to unit length."""
    array = np.asarray(vectors, float)
    return np.asarray(array / np.linalg.norm(array, axis=-1, keepdims=True))


def rotation_from_axes(y: ArrayLike, towards_z: ArrayLike) -> Array:
    """Rotations (..., 3, 3) whose y axis is y and whose z axis leans towards towards_z.

    Both arguments are (..., 3), of any length but zero, and not parallel.
    """
    y_axis = normalised(y)
    x_axis = normalised(np.cross(y_axis, np.asarray(towards_z, float)))
    return np.stack(np.broadcast_arrays(x_axis, y_axis, np.cross(x_axis, y_axis)), axis=-1)


def interpolate(first: Transform, second: Transform, share: Array) -> Transform:
    """From first (share 0) to second (share 1), along a line and the shortest rotation.

    share (T,); first and second are series (T, ...).
    """
    between = np.swapaxes(first.rotation, -1, -2) @ second.rotation
    turn = Rotation.from_matrix(between).as_rotvec() * share[:, None]
    return Transform(
        first.translation + share[:, None] * (second.translation - first.translation),
        first.rotation @ Rotation.from_rotvec(turn).as_matrix(),
    )


def quaternions(rotation: Array) -> Array:
    """Unit quaternions (T, 4), (w, x, y, z), of rotations (T, 3, 3), of continuous sign."""
    rotated = Rotation.from_matrix(rotation).as_quat(scalar_first=True)
    flips = np.sum(rotated[1:] * rotated[:-1], axis=1) < 0
    signs = np.where(np.cumsum(np.concatenate([[rotated[0, 0] < 0], flips])) % 2 == 1, -1.0, 1.0)
    return np.asarray(rotated * signs[:, None])
