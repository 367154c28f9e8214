"""Rigid transforms as matrices (..., 4, 4): ``a_from_b`` takes points of frame b to frame a."""

import numpy as np
from inhand_schemas.messages import Pose
from scipy.spatial.transform import Rotation

from inhand_calibration.arrays import Array


def rigid(rotation: Array, translation: Array) -> Array:
    """Join rotation matrices (..., 3, 3) and translations (..., 3)."""
    joined = np.zeros((*rotation.shape[:-2], 4, 4))
    joined[..., :3, :3] = rotation
    joined[..., :3, 3] = translation
    joined[..., 3, 3] = 1.0
    return joined


def inverse(transforms: Array) -> Array:
    """Return the inverse transforms (..., 4, 4)."""
    turned = np.swapaxes(transforms[..., :3, :3], -1, -2)
    return rigid(turned, -(turned @ transforms[..., :3, 3:])[..., 0])


def moved(transforms: Array, points: Array) -> Array:
    """Take points (..., N, 3) through transforms (..., 4, 4)."""
    turned = points @ np.swapaxes(transforms[..., :3, :3], -1, -2)
    return turned + transforms[..., None, :3, 3]


def turned_by(vectors: Array) -> Array:
    """Return the matrices (..., 3, 3) of rotation vectors (..., 3), radians."""
    flat = Rotation.from_rotvec(vectors.reshape(-1, 3)).as_matrix()
    return flat.reshape(*vectors.shape[:-1], 3, 3)


def cross_matrices(vectors: Array) -> Array:
    """Return matrices (..., 3, 3) whose product with a vector is the cross product by it."""
    x, y, z = np.moveaxis(vectors, -1, 0)
    zero = np.zeros_like(x)
    rows = ((zero, -z, y), (z, zero, -x), (-y, x, zero))
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def angle(rotation: Array) -> float:
    """Return by how much a matrix (3, 3) rotates, radians."""
    return float(Rotation.from_matrix(rotation).magnitude())


def of_pose(pose: Pose) -> Array:
    """Return the matrix (4, 4) of a message's pose."""
    rotation = Rotation.from_quat(pose.rotation, scalar_first=True).as_matrix()
    return rigid(rotation, np.array(pose.translation))


def to_pose(transform: Array) -> Pose:
    """Return a matrix (4, 4) as a message's pose."""
    rotation = Rotation.from_matrix(transform[:3, :3]).as_quat(canonical=True, scalar_first=True)
    w, x, y, z = map(float, rotation)
    a, b, c = map(float, transform[:3, 3])
    return Pose((a, b, c), (w, x, y, z))


def rigid_fit(source: Array, target: Array, weights: Array) -> Array:
    """Find the transform (4, 4) that takes points (N, 3) best to others, by weights (N,)."""
    share = weights / weights.sum()
    source_centre, target_centre = share @ source, share @ target
    spread = (share[:, None] * (target - target_centre)).T @ (source - source_centre)
    left, _, right = np.linalg.svd(spread)
    handed = np.diag([1.0, 1.0, np.sign(np.linalg.det(left @ right))])
    rotation = left @ handed @ right
    return rigid(rotation, target_centre - rotation @ source_centre)
