"""Poses on the way from one to another."""

from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array


def between(
    first: tuple[Array, Array], last: tuple[Array, Array], shares: Array
) -> tuple[Array, Array]:
    """Return the poses (T, 3) and (T, 4) at ``shares`` (T,) of the way from one pose to another.

    Translations are linear, and rotations turn evenly about one axis, the shorter way (SLERP).
    """
    way = rotations.to_vector(rotations.multiply(rotations.conjugate(first[1]), last[1]))
    turns = rotations.from_vector(shares[:, None] * way)
    return (
        first[0] + shares[:, None] * (last[0] - first[0]),
        rotations.multiply(first[1], turns),
    )
