"""The browser's camera at the place of a rig's camera.

A browser looks through a camera whose middle is the middle of its window, and which has one focal
length; a rig's camera seldom has. Both are at one place, so that each pixel of one is a pixel of
the other, whatever the depth (a homography).
"""

from dataclasses import dataclass

import cv2
import numpy as np
from inhand_tracker.geometry.arrays import Array, Bytes, Singles
from inhand_tracker.geometry.camera import Intrinsics


@dataclass(frozen=True)
class Eye:
    """A camera at a rig's camera: ``camera_from_eye`` (3, 3) is its rotation, and ``lens`` tells
    its image."""

    camera_from_eye: Array
    lens: Intrinsics

    @property
    def vertical_angle(self) -> float:
        """The angle in radians that it sees from top to bottom."""
        return float(2.0 * np.arctan(0.5 * self.lens.height / self.lens.fy))

    def see(self, colour: Bytes, camera: Intrinsics) -> Bytes:
        """Return what the eye sees (h, w, 3) of the camera's image (H, W, 3), black around it."""
        size = self.lens.width, self.lens.height
        flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
        return np.asarray(
            cv2.warpPerspective(colour, self._to(camera), size, flags=flags), np.uint8
        )

    def see_depth(self, depth: Singles, camera: Intrinsics) -> Singles:
        """Return the eye's depth (h, w) in metres of the camera's (H, W); 0 where there is none."""
        size = self.lens.width, self.lens.height
        flags = cv2.INTER_NEAREST | cv2.WARP_INVERSE_MAP
        along = cv2.warpPerspective(depth, self._to(camera), size, flags=flags)
        columns, rows = np.arange(size[0]), np.arange(size[1])
        x, y = (columns - self.lens.cx) / self.lens.fx, (rows - self.lens.cy) / self.lens.fy
        third = self.camera_from_eye[2]
        return np.asarray(along / (third[0] * x + third[1] * y[:, None] + third[2]), np.float32)

    def _to(self, camera: Intrinsics) -> Array:
        """Return the homography (3, 3) from the eye's pixels to the camera's."""
        return np.asarray(
            _matrix(camera) @ self.camera_from_eye @ np.linalg.inv(_matrix(self.lens))
        )


def whole_eye(camera: Intrinsics, aspect: float, height: int) -> Eye:
    """Make an eye that sees all of a camera's image, in one of that ``height`` and aspect."""
    left, top = camera.cx + 0.5, camera.cy + 0.5
    across = max(left, camera.width - left) / camera.fx
    up = max(top, camera.height - top) / camera.fy
    return _eye(np.eye(3), max(up, across / aspect), aspect, height)


def eye_towards(point: Array, reach: float, aspect: float, height: int) -> Eye:
    """Make an eye that looks at a point (3,) in the camera frame, and sees so much around it.

    It sees ``reach`` metres, at the point's distance, above and below it, and does not roll.
    """
    forward = point / np.linalg.norm(point)
    right = np.cross([0.0, 1.0, 0.0], forward)
    right /= np.linalg.norm(right)
    turned = np.column_stack((right, np.cross(forward, right), forward))
    return _eye(turned, reach / float(np.linalg.norm(point)), aspect, height)


def _eye(turned: Array, tangent: float, aspect: float, height: int) -> Eye:
    """Make an eye by the tangent of half the angle that it sees from top to bottom."""
    width = max(1, round(aspect * height))
    focal = 0.5 * width / (aspect * tangent), 0.5 * height / tangent
    middle = 0.5 * (width - 1), 0.5 * (height - 1)
    return Eye(turned, Intrinsics(*focal, *middle, width, height))


def _matrix(camera: Intrinsics) -> Array:
    return np.array([[camera.fx, 0.0, camera.cx], [0.0, camera.fy, camera.cy], [0.0, 0.0, 1.0]])
