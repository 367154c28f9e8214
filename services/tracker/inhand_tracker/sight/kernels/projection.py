"""What the kernels share: a pose's view of an object, and its points in the image.

Everything here is compiled into its callers, in their precision, float32 or float64. Pixels are
counted from the image's corner, so that a pixel's column is the whole part of u: the ``lens`` is
(fx, fy, cx + 1/2, cy + 1/2).
"""

from typing import Any, TypeAlias

import numpy as np
from inhand_runtime.compiled import njit
from numpy.typing import NDArray

from inhand_tracker.geometry.camera import NEAREST_M
from inhand_tracker.shape.kernels.nearest_view import nearest_view

Real: TypeAlias = Any
"""float32 or float64, as the caller has it; or an array of it."""
Matrix: TypeAlias = tuple[Real, ...]
"""The nine elements of a rotation matrix, row by row."""

NEAREST = np.float32(NEAREST_M)


@njit(cache=True, nogil=True, inline="always", fastmath=True)
def rotation_matrix(w: Real, x: Real, y: Real, z: Real) -> Matrix:
    """Turn a unit quaternion into a rotation matrix, row by row."""
    one, two = np.float32(1.0), np.float32(2.0)
    return (
        one - two * (y * y + z * z),
        two * (x * y - w * z),
        two * (x * z + w * y),
        two * (x * y + w * z),
        one - two * (x * x + z * z),
        two * (y * z - w * x),
        two * (x * z - w * y),
        two * (y * z + w * x),
        one - two * (x * x + y * y),
    )


@njit(cache=True, nogil=True, inline="always")
def view_of_pose(
    grid: NDArray[np.int16], directions: Real, turn: Matrix, tx: Real, ty: Real, tz: Real
) -> int:
    """Find the direction from which an object at (tx, ty, tz), turned by ``turn``, is seen."""
    return nearest_view(
        grid,
        directions,
        -(turn[0] * tx + turn[3] * ty + turn[6] * tz),
        -(turn[1] * tx + turn[4] * ty + turn[7] * tz),
        -(turn[2] * tx + turn[5] * ty + turn[8] * tz),
    )


@njit(cache=True, nogil=True, inline="always")
def rotated(turn: Matrix, a: Real, b: Real, c: Real) -> tuple[Real, Real, Real]:
    """Rotate the vector (a, b, c)."""
    return (
        turn[0] * a + turn[1] * b + turn[2] * c,
        turn[3] * a + turn[4] * b + turn[5] * c,
        turn[6] * a + turn[7] * b + turn[8] * c,
    )


@njit(cache=True, nogil=True, inline="always")
def projected(lens: tuple[Real, ...], x: Real, y: Real, z: Real) -> tuple[Real, Real]:
    """Project the point (x, y, z) of the camera frame into the image."""
    return lens[0] * x / z + lens[2], lens[1] * y / z + lens[3]


@njit(cache=True, nogil=True, inline="always")
def in_image(u: Real, v: Real, width: Real, height: Real) -> bool:
    """Return whether (u, v) lies in the image; not a number does not."""
    zero = np.float32(0.0)
    return u >= zero and v >= zero and u < width and v < height


@njit(cache=True, nogil=True, inline="always")
def is_covered(measured: Real, depth: Real, margin: Real) -> bool:
    """Return whether a measured depth lies before a point by more than a margin; 0 is none."""
    return measured > np.float32(0.0) and measured < depth - margin


@njit(cache=True, nogil=True, inline="always")
def image_normal(
    lens: tuple[Real, ...],
    normal: tuple[Real, Real, Real],
    x: Real,
    y: Real,
    z: Real,
) -> tuple[Real, Real]:
    """Return the direction, of any length, in which the pixel of (x, y, z) moves when that point,
    or another one of its ray, moves along its normal."""
    along = normal[2] / z
    return lens[0] * (normal[0] - along * x), lens[1] * (normal[1] - along * y)


@njit(cache=True, nogil=True, inline="always", fastmath=True)
def edge_channel(x: Real, y: Real) -> int:
    """Find the channel of edges that run across a normal (x, y) in the image."""
    ax, ay = abs(x), abs(y)
    if ay < np.float32(0.41421356) * ax:
        return 0
    if ax < np.float32(0.41421356) * ay:
        return 2
    return 1 if x * y > np.float32(0.0) else 3


@njit(cache=True, nogil=True, inline="always")
def depth_noise(near: Real, growth: Real, depth: Real) -> Real:
    """Return the standard deviation of a measured depth, in metres: ``near`` close by, with a
    ``growth`` with the square of the depth."""
    return near + growth * depth * depth
