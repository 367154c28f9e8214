"""The pinhole camera: projection of points to pixels and back."""

from dataclasses import dataclass

import numpy as np
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
        depth = points[..., 2:]
        with np.errstate(invalid="ignore", divide="ignore"):
            plane = np.where(depth > NEAREST_M, points[..., :2] / depth, np.nan)
        return plane * [self.fx, self.fy] + [self.cx, self.cy]

    def unproject(self, pixels: Array, depths: Array) -> Array:
        """Find the points (N, 3) in the camera frame at pixels (N, 2) and depths (N,) in metres."""
        across = (pixels - [self.cx, self.cy]) / [self.fx, self.fy]
        return np.column_stack((across * depths[:, None], depths))


def intrinsics_of(info: CameraInfo) -> Intrinsics:
    """Take the pinhole part of a camera's description."""
    return Intrinsics(info.fx, info.fy, info.cx, info.cy, info.width, info.height)
