"""Unit quaternions (w, x, y, z) on arrays of shape (..., 4).

What trackers call often, on few poses at once, is compiled (``kernels/quaternions``).
"""

import numpy as np
from inhand_runtime.compiled import njit, vectorised

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.kernels.nearest_rotation import principal_vector
from inhand_tracker.geometry.kernels.quaternions import (
    product,
    quaternion_in,
    quaternion_of,
    quaternion_of_matrix,
    set_matrix,
    set_quaternion,
    turned,
    vector_in,
    vector_of,
)
from inhand_tracker.geometry.kernels.vectors import set_vector

_CONJUGATE = np.array([1.0, -1.0, -1.0, -1.0])
_THREE, _FOUR = np.zeros(3), np.zeros(4)
"""They tell compiled functions how long their results are."""


def components(array: Array) -> tuple[Array, ...]:
    """Take the last axis of an array apart."""
    return tuple(array[..., index] for index in range(array.shape[-1]))


def multiply(first: Array, second: Array) -> Array:
    """Chain rotations: ``second`` followed by ``first``, (..., 4)."""
    return _multiply(first, second)


def conjugate(quaternion: Array) -> Array:
    """Invert rotations, (..., 4)."""
    return quaternion * _CONJUGATE


def rotate(quaternion: Array, vector: Array) -> Array:
    """Turn vectors (..., 3) by quaternions (..., 4)."""
    return _rotate(quaternion, vector)


def to_matrix(quaternion: Array) -> Array:
    """Rotation matrices (..., 3, 3)."""
    return _to_matrix(quaternion, _THREE)


def from_matrix(matrix: Array) -> Array:
    """Quaternions (..., 4) of rotation matrices (..., 3, 3), by the largest component."""
    return _from_matrix(matrix, _FOUR)


def from_vector(vector: Array) -> Array:
    """Quaternions (..., 4) of rotation vectors (..., 3) in radians."""
    return _from_vector(vector, _FOUR)


def to_vector(quaternion: Array) -> Array:
    """Rotation vectors (..., 3) in radians, no longer than π."""
    return _to_vector(quaternion, _THREE)


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
    return _mean(quaternion, weights)


def principal(scatter: Array) -> Array:
    """Find the mean rotations (..., 4) of scatter matrices Σ w q qᵀ, (..., 4, 4); the greatest
    component of each is positive."""
    return _principal(scatter)


@vectorised("(q),(q)->(q)")
def _multiply(first: Array, second: Array, chained: Array) -> None:
    set_quaternion(chained, product(quaternion_in(first), quaternion_in(second)))


@vectorised("(q),(v)->(v)")
def _rotate(quaternion: Array, vector: Array, rotated: Array) -> None:
    set_vector(rotated, turned(quaternion_in(quaternion), vector_in(vector)))


@vectorised("(v),(q)->(q)")
def _from_vector(vector: Array, four: Array, quaternion: Array) -> None:
    set_quaternion(quaternion, quaternion_of(vector_in(vector)))


@vectorised("(q),(v)->(v)")
def _to_vector(quaternion: Array, three: Array, vector: Array) -> None:
    set_vector(vector, vector_of(quaternion_in(quaternion)))


@vectorised("(q),(v)->(v,v)")
def _to_matrix(quaternion: Array, three: Array, matrix: Array) -> None:
    set_matrix(matrix, quaternion_in(quaternion))


@vectorised("(v,v),(q)->(q)")
def _from_matrix(matrix: Array, four: Array, quaternion: Array) -> None:
    set_quaternion(quaternion, quaternion_of_matrix(matrix))


@njit(cache=True, nogil=True)
def _set_principal(quaternion: Array, scatter: Array) -> None:
    """Set the principal quaternion of a scatter matrix, which is used up."""
    found = principal_vector(scatter)
    greatest = found[np.argmax(np.abs(found))]
    quaternion[:] = found if greatest >= 0.0 else -found


@vectorised("(n,q),(n)->(q)")
def _mean(quaternions: Array, weights: Array, quaternion: Array) -> None:
    scatter = np.zeros((4, 4))
    for index in range(len(quaternions)):
        for row in range(4):
            weighted = weights[index] * quaternions[index, row]
            for column in range(4):
                scatter[row, column] += weighted * quaternions[index, column]
    _set_principal(quaternion, scatter)


@vectorised("(q,q)->(q)")
def _principal(scatter: Array, quaternion: Array) -> None:
    _set_principal(quaternion, scatter.copy())
