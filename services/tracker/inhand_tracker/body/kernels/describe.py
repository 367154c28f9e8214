"""A body's joints from the middle of the trunk, in its directions."""

from inhand_runtime.compiled import njit, vectorised

from inhand_tracker.body.kernels.axes import CHEST, HIPS, trunk_of
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.kernels.quaternions import Vector, vector_in
from inhand_tracker.geometry.kernels.vectors import blended, dot, minus, set_vector


@njit(cache=True, nogil=True, inline="always")
def _scaled_in(axes: tuple[Vector, Vector, Vector], vector: Vector, scale: float) -> Vector:
    """Give a vector in three directions, times ``scale``."""
    return (
        scale * dot(vector, axes[0]),
        scale * dot(vector, axes[1]),
        scale * dot(vector, axes[2]),
    )


@vectorised("(j,v),()->(j,v)")
def places(joints: Array, height: float, placed: Array) -> None:
    """Fill ``placed`` (20, 3) with the joints (20, 3) from the trunk, in body heights."""
    axes = trunk_of(joints)
    middle = blended(vector_in(joints[CHEST]), 1.0, vector_in(joints[HIPS]))
    for joint in range(len(joints)):
        away = blended(vector_in(joints[joint]), -0.5, middle)
        set_vector(placed[joint], _scaled_in(axes, away, 1.0 / height))


@vectorised("(j,v),(l,j,v),()->(l,j,v)")
def ways(joints: Array, earlier: Array, height: float, gone: Array) -> None:
    """Fill ``gone`` (L, 20, 3) with half of the ways from earlier joints (L, 20, 3) to those of now
    (20, 3), in the trunk's directions and body heights."""
    axes = trunk_of(joints)
    for lag in range(len(earlier)):
        for joint in range(len(joints)):
            way = minus(vector_in(joints[joint]), vector_in(earlier[lag, joint]))
            set_vector(gone[lag, joint], _scaled_in(axes, way, 0.5 / height))
