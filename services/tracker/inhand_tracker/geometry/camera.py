"""The pinhole camera: projection of points to pixels and back."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from inhand_runtime.compiled import vectorised
from inhand_schemas.messages import CameraInfo

from inhand_tracker.geometry.arrays import Array

NEAREST_M = 0.05
"""Metres before the camera within which a point is taken to have no pixel."""


@dataclass(frozen=True)
class Intrinsics:
    """Projects as a camera does: focal lengths, principal point and image size in pixels."""

    fx: float
    fy: float
    cx: float
    cy: float
    width: int
    height: int

    def scaled_to(self, width: int, height: int) -> "Intrinsics":
        """Give the intrinsics of the same view in an image of another size."""
        x, y = width / self.width, height / self.height
        return Intrinsics(
            self.fx * x,
            self.fy * y,
            (self.cx + 0.5) * x - 0.5,
            (self.cy + 0.5) * y - 0.5,
            width,
            height,
        )

    def project(self, points: Array) -> Array:
        """Project points (..., 3) in the camera frame to pixels (..., 2); NaN behind the camera."""
        return _project(points, self.lens, _PIXEL)

    @cached_property
    def lens(self) -> Array:
        """Focal lengths and principal point as compiled functions take them, (4,)."""
        return np.array([self.fx, self.fy, self.cx, self.cy])

    def unproject(self, pixels: Array, depths: Array) -> Array:
        """Find the points (N, 3) in the camera frame at pixels (N, 2) and depths (N,) in metres."""
        across = (pixels - [self.cx, self.cy]) / [self.fx, self.fy]
        return np.column_stack((across * depths[:, None], depths))


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
