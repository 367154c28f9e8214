"""Unit quaternions (w, x, y, z) on arrays of shape (..., 4)."""

import numpy as np

from inhand_tracker.geometry.arrays import Array


def components(array: Array) -> tuple[Array, ...]:
    """Take the last axis of an array apart."""
    return tuple(array[..., index] for index in range(array.shape[-1]))


def multiply(first: Array, second: Array) -> Array:
    """Chain rotations: ``second`` followed by ``first``, (..., 4)."""
    w, x, y, z = components(first)
    a, b, c, d = components(second)
    return np.stack(
        (
            w * a - x * b - y * c - z * d,
            w * b + x * a + y * d - z * c,
            w * c - x * d + y * a + z * b,
            w * d + x * c - y * b + z * a,
        ),
        axis=-1,
    )


def conjugate(quaternion: Array) -> Array:
    """Invert rotations, (..., 4)."""
    return quaternion * np.array([1.0, -1.0, -1.0, -1.0])


def rotate(quaternion: Array, vector: Array) -> Array:
    """Turn vectors (..., 3) by quaternions (..., 4)."""
    w, x, y, z = components(quaternion)
    a, b, c = components(vector)
    # Twice the cross product of axis and vector; np.cross is many times slower on small arrays.
    u, v, s = 2.0 * (y * c - z * b), 2.0 * (z * a - x * c), 2.0 * (x * b - y * a)
    return np.stack(
        (
            a + w * u + y * s - z * v,
            b + w * v + z * u - x * s,
            c + w * s + x * v - y * u,
        ),
        axis=-1,
    )


def to_matrix(quaternion: Array) -> Array:
    """Rotation matrices (..., 3, 3)."""
    w, x, y, z = components(quaternion)
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def from_matrix(matrix: Array) -> Array:
    """Quaternions (..., 4) of rotation matrices (..., 3, 3), by the largest component."""
    diagonal = np.einsum("...ii->...i", matrix)
    trace = diagonal.sum(axis=-1, keepdims=True)
    squares = np.concatenate((trace, 2.0 * diagonal - trace), axis=-1) + 1.0
    largest = np.argmax(squares, axis=-1)
    skew = np.stack(
        (
            matrix[..., 2, 1] - matrix[..., 1, 2],
            matrix[..., 0, 2] - matrix[..., 2, 0],
            matrix[..., 1, 0] - matrix[..., 0, 1],
        ),
        axis=-1,
    )
    symmetric = matrix + np.swapaxes(matrix, -1, -2)
    candidates = np.empty((*matrix.shape[:-2], 4, 4))
    candidates[..., 0, 0] = squares[..., 0]
    candidates[..., 0, 1:] = candidates[..., 1:, 0] = skew
    candidates[..., 1:, 1:] = symmetric
    for axis in range(3):
        candidates[..., axis + 1, axis + 1] = squares[..., axis + 1]
    chosen = np.take_along_axis(candidates, largest[..., None, None], axis=-2)[..., 0, :]
    return normalise(chosen)


def from_vector(vector: Array) -> Array:
    """Quaternions (..., 4) of rotation vectors (..., 3) in radians."""
    angle = np.linalg.norm(vector, axis=-1, keepdims=True)
    return np.concatenate(
        (np.cos(angle / 2.0), vector * (0.5 * np.sinc(angle / (2.0 * np.pi)))), axis=-1
    )


def to_vector(quaternion: Array) -> Array:
    """Rotation vectors (..., 3) in radians, no longer than π."""
    upper = np.where(quaternion[..., :1] < 0.0, -quaternion, quaternion)
    sine = np.linalg.norm(upper[..., 1:], axis=-1, keepdims=True)
    angle = 2.0 * np.arctan2(sine, upper[..., :1])
    scale = np.divide(angle, sine, out=np.full_like(sine, 2.0), where=sine > 1e-12)
    return upper[..., 1:] * scale


def normalise(quaternion: Array) -> Array:
    """Scale quaternions (..., 4) to unit length."""
    return quaternion / np.linalg.norm(quaternion, axis=-1, keepdims=True)


def separation(first: Array, second: Array) -> Array:
    """θ of Darby et al. 2014, equation 2: acos |q·q'|, half of the angle between rotations."""
    cosine = np.abs(np.einsum("...i,...i->...", first, second))
    return np.arccos(np.minimum(cosine, 1.0))


def angle_between(first: Array, second: Array) -> Array:
    """Angle, in radians from 0 to π, of the rotation that takes one to the other."""
    return 2.0 * separation(first, second)


def mean(quaternion: Array, weights: Array) -> Array:
    """Average rotations by weights, over the last axis but one (Markley et al. 2007).

    ``quaternion`` is (..., N, 4) and ``weights`` broadcasts to (..., N); the result (..., 4) does
    not depend on the quaternions' signs.
    """
    scatter = np.einsum("...n,...ni,...nj->...ij", weights, quaternion, quaternion)
    return principal(scatter)


def principal(scatter: Array) -> Array:
    """Find the mean rotations (..., 4) of scatter matrices Σ w q qᵀ, (..., 4, 4)."""
    _, vectors = np.linalg.eigh(scatter)
    return vectors[..., -1]
