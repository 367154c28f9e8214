"""Vectors one by one, as tuples of three numbers. Everything here is compiled into its callers."""

import numpy as np
from inhand_runtime.compiled import njit

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.kernels.quaternions import Vector

SHORTEST = 1e-9
"""Length below which a vector has no direction; its unit is shorter than 1."""


@njit(cache=True, nogil=True, inline="always")
def minus(first: Vector, second: Vector) -> Vector:
    """Subtract the second vector from the first."""
    return first[0] - second[0], first[1] - second[1], first[2] - second[2]


@njit(cache=True, nogil=True, inline="always")
def blended(first: Vector, share: float, second: Vector) -> Vector:
    """Add a ``share`` of the second vector to the first."""
    return (
        first[0] + share * second[0],
        first[1] + share * second[1],
        first[2] + share * second[2],
    )


@njit(cache=True, nogil=True, inline="always")
def dot(first: Vector, second: Vector) -> float:
    """Multiply two vectors with each other."""
    return first[0] * second[0] + first[1] * second[1] + first[2] * second[2]


@njit(cache=True, nogil=True, inline="always")
def cross(first: Vector, second: Vector) -> Vector:
    """Find the vector that stands upright on two."""
    return (
        first[1] * second[2] - first[2] * second[1],
        first[2] * second[0] - first[0] * second[2],
        first[0] * second[1] - first[1] * second[0],
    )


@njit(cache=True, nogil=True, inline="always")
def unit(vector: Vector) -> Vector:
    """Scale a vector to length 1."""
    length = max(np.sqrt(dot(vector, vector)), SHORTEST)
    return vector[0] / length, vector[1] / length, vector[2] / length


@njit(cache=True, nogil=True, inline="always")
def set_vector(array: Array, vector: Vector) -> None:
    """Write a vector into an array (3,)."""
    array[0], array[1], array[2] = vector


@njit(cache=True, nogil=True, inline="always")
def set_columns(array: Array, x: Vector, y: Vector, z: Vector) -> None:
    """Write three vectors into the columns of an array (3, 3)."""
    for row in range(3):
        array[row, 0], array[row, 1], array[row, 2] = x[row], y[row], z[row]
