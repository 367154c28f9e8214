"""How a camera's lens maps points to pixels: pinhole and OpenCV's distortion, with derivatives."""

from dataclasses import dataclass, replace
from typing import Self

import cv2
import numpy as np
from inhand_schemas.messages import CameraInfo

from inhand_calibration.arrays import Array

_STILL = np.zeros((3, 1))
"""No turn, and no shift. As (3,) OpenCV 5.0 takes it for another shape here and there."""


@dataclass(frozen=True)
class Lens:
    """Intrinsics in pixels of an image of ``width`` × ``height``; ``distortion`` as OpenCV has."""

    fx: float
    fy: float
    cx: float
    cy: float
    width: int
    height: int
    distortion: tuple[float, ...] = ()

    @classmethod
    def of_info(cls, info: CameraInfo) -> Self:
        """Return the lens that a camera says it has."""
        return cls(
            info.fx, info.fy, info.cx, info.cy, info.width, info.height, _whole(info.distortion)
        )

    @property
    def matrix(self) -> Array:
        """The camera matrix (3, 3)."""
        return np.array([[self.fx, 0.0, self.cx], [0.0, self.fy, self.cy], [0.0, 0.0, 1.0]])

    @property
    def coefficients(self) -> Array:
        """The distortion (D,) in OpenCV's order."""
        return np.array(self.distortion or (0.0,) * 4)

    def changed(self, focal: float, x: float, y: float) -> "Lens":
        """Return a lens of a focal length that is longer by a share of it, whose principal point is
        shifted by pixels."""
        scale = 1.0 + focal
        return replace(self, fx=self.fx * scale, fy=self.fy * scale, cx=self.cx + x, cy=self.cy + y)

    def project(self, points: Array) -> Array:
        """Project points (N, 3) in the camera's frame to pixels (N, 2)."""
        if len(points) == 0:
            return np.empty((0, 2))
        pixels, _ = cv2.projectPoints(points, _STILL, _STILL, self.matrix, self.coefficients)
        return np.reshape(pixels, (-1, 2)).astype(np.float64)

    def project_with_slopes(self, points: Array) -> tuple[Array, Array]:
        """Project points (N, 3) to pixels (N, 2), with their derivatives (N, 2, 3) by the points.

        Those are what OpenCV gives for a movement of all points.
        """
        pixels, slopes = cv2.projectPoints(points, _STILL, _STILL, self.matrix, self.coefficients)
        return (
            np.reshape(pixels, (-1, 2)).astype(np.float64),
            slopes[:, 3:6].reshape(-1, 2, 3).astype(np.float64),
        )

    def undistorted(self, pixels: Array) -> Array:
        """Return x and y (N, 2), at a depth of 1, of what is seen at pixels (N, 2)."""
        if len(pixels) == 0:
            return np.empty((0, 2))
        rays = cv2.undistortPoints(
            np.ascontiguousarray(pixels[:, None]), self.matrix, self.coefficients
        )
        return np.reshape(rays, (-1, 2)).astype(np.float64)


def _whole(distortion: tuple[float, ...]) -> tuple[float, ...]:
    """Fill coefficients up to a number that OpenCV takes: 4, 5, 8, 12 or 14; none stay none."""
    count = next(count for count in (0, 4, 5, 8, 12, 14) if count >= len(distortion))
    return (*distortion, *(0.0,) * (count - len(distortion)))
