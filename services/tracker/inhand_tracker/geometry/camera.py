"""The pinhole camera: projection of points to pixels and back."""

from functools import cached_property

import numpy as np
from inhand_runtime.compiled import vectorised
from inhand_runtime.pinhole import Pinhole
from inhand_schemas.messages import CameraInfo

from inhand_tracker.geometry.arrays import Array

NEAREST_M = 0.05
"""Metres before the camera within which a point is taken to have no pixel."""


class Intrinsics(Pinhole):
    """Projects as a camera does."""

    def project(self, points: Array) -> Array:
        """Project points (..., 3) in the camera frame to pixels (..., 2); NaN behind the camera."""
        return _project(points, self.lens, _PIXEL)

    @cached_property
    def lens(self) -> Array:
        """Focal lengths and principal point as compiled functions take them, (4,)."""
        return np.array([self.fx, self.fy, self.cx, self.cy])

    def unproject(self, pixels: Array, depths: Array) -> Array:
        """Find the points (N, 3) in the camera frame at pixels (N, 2) and depths (N,) in metres."""
        return np.column_stack((self.rays(pixels) * depths[:, None], depths))


_PIXEL = np.zeros(2)
"""It tells the compiled function how long a pixel is."""


@vectorised("(v),(l),(p)->(p)")
def _project(point: Array, lens: Array, two: Array, pixel: Array) -> None:
    if point[2] > NEAREST_M:
        pixel[0] = point[0] / point[2] * lens[0] + lens[2]
        pixel[1] = point[1] / point[2] * lens[1] + lens[3]
    else:
        pixel[:] = np.nan


def intrinsics_of(info: CameraInfo) -> Intrinsics:
    """Take the pinhole part of a camera's description."""
    return Intrinsics(info.fx, info.fy, info.cx, info.cy, info.width, info.height)
