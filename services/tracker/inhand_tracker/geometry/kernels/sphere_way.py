"""How far a sphere goes in an image."""

import numpy as np
from inhand_runtime.compiled import vectorised

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import NEAREST_M
from inhand_tracker.geometry.kernels.quaternions import quaternion_in, set_matrix


@vectorised("(v),(q),(v),(q),(),(l)->()")
def farthest_way(
    centre: Array,
    rotation: Array,
    later_centre: Array,
    later_rotation: Array,
    radius: float,
    lens: Array,
    way: Array,
) -> None:
    """Find how many pixels the farthest of six points goes, those of a sphere about a pose's centre
    (3,) on its axes, seen through a ``lens`` (fx, fy, cx, cy); 0 where none is before the camera.
    """
    axes, later_axes = np.empty((3, 3)), np.empty((3, 3))
    set_matrix(axes, quaternion_in(rotation))
    set_matrix(later_axes, quaternion_in(later_rotation))
    farthest = 0.0
    for axis in range(3):
        for reach in (radius, -radius):
            z = centre[2] + reach * axes[2, axis]
            later_z = later_centre[2] + reach * later_axes[2, axis]
            if not (z > NEAREST_M and later_z > NEAREST_M):
                continue
            square = 0.0
            for side in range(2):
                place = (centre[side] + reach * axes[side, axis]) / z
                later = (later_centre[side] + reach * later_axes[side, axis]) / later_z
                square += ((later - place) * lens[side]) ** 2
            farthest = max(farthest, square)
    way[0] = np.sqrt(farthest)
