"""The equations of Gauss-Newton steps, and one measurement after the other that they are of."""

from typing import NamedTuple

from inhand_runtime.compiled import njit

from inhand_tracker.geometry.arrays import Array

FAST = {"nsz", "arcp", "contract", "afn", "reassoc"}
"""What compiled code may make of sums and products to be fast; not a number stays one."""


class Equations(NamedTuple):
    """The Gauss-Newton equations of K poses: ``information`` (K, 6, 6) and ``gradients`` (K, 6),
    for a translation and then a rotation vector on the left, both in the camera frame."""

    information: Array
    gradients: Array


@njit(cache=True, nogil=True, inline="always", fastmath=FAST)
def exponential(x: float) -> float:
    """Return eˣ of a number up to 0, to 4e-4 of it (1e-6 above -5); below -20 that of -20.

    Several at once are many times faster than the exact function's.
    """
    y = max(x, -20.0) / 256.0
    power = 1.0 + y * (1.0 + y * (0.5 + y / 6.0))
    for _ in range(8):
        power *= power
    return power


@njit(cache=True, nogil=True, inline="always", fastmath=FAST)
def row_of(
    across: tuple[float, float, float], arm: tuple[float, float, float]
) -> tuple[float, float, float, float, float, float]:
    """Return by how much a point at ``arm`` from the origin moves along ``across``, by each element
    of a step."""
    return (
        across[0],
        across[1],
        across[2],
        arm[1] * across[2] - arm[2] * across[1],
        arm[2] * across[0] - arm[0] * across[2],
        arm[0] * across[1] - arm[1] * across[0],
    )


@njit(cache=True, nogil=True, inline="always", fastmath=FAST)
def add(
    equation: tuple[Array, Array],
    row: tuple[float, float, float, float, float, float],
    residual: float,
    weight: float,
) -> None:
    """Add one measurement: a point is off by ``residual`` in the direction of its ``row_of``."""
    information, gradient = equation
    for i in range(6):
        gradient[i] += weight * residual * row[i]
        for j in range(6):
            information[i, j] += weight * row[i] * row[j]


@njit(cache=True, nogil=True, inline="always", fastmath=FAST)
def add_common(
    common: Array,
    row: tuple[float, float, float, float, float, float],
    residual: float,
    weight: float,
) -> None:
    """Add a measurement to ``common`` (8,), the sums of weights times rows, residuals, and one."""
    for i in range(6):
        common[i] += weight * row[i]
    common[6] += weight * residual
    common[7] += weight


@njit(cache=True, nogil=True, inline="always", fastmath=FAST)
def take_common(equation: tuple[Array, Array], common: Array, deviation: float) -> None:
    """Take out of an equation what an error explains that all of the ``common`` (8,) measurements
    share, of a standard ``deviation`` (the error is marginalised)."""
    information, gradient = equation
    whole = common[7] + 1.0 / (deviation * deviation)
    for i in range(6):
        gradient[i] -= common[i] * common[6] / whole
        for j in range(6):
            information[i, j] -= common[i] * common[j] / whole
