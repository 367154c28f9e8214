"""Where a camera is taken to be, and how its clock is taken to run."""

from dataclasses import dataclass

import numpy as np
from inhand_schemas.messages import Pose

from inhand_calibration.arrays import Array
from inhand_calibration.rigid import angle, of_pose


@dataclass(frozen=True)
class CameraEstimate:
    """A camera's pose in the reference camera's frame, and its clock.

    ``rotation`` (3, 3) and ``translation`` (3,) are reference_from_camera. The reference's time is
    the camera's plus ``offset`` plus ``drift`` times the time since ``middle``, seconds, by clocks
    that begin with each camera's first frame. People are seen ``surface`` metres nearer to the
    camera than they are.
    """

    rotation: Array
    translation: Array
    offset: float = 0.0
    drift: float = 0.0
    surface: float = 0.0
    middle: float = 0.0

    def camera_times(self, times: Array) -> Array:
        """Return the camera's times at times (K,) of the reference, seconds."""
        return times - self.offset - self.drift * (times - self.middle)

    def apply(self, points: Array) -> Array:
        """Return points (..., 3) of the camera's frame as the reference's."""
        return points @ self.rotation.T + self.translation

    def seen_through(self, points: Array) -> Array:
        """Return points (..., 3) of people as the reference's, behind the surface that was seen."""
        away = points / np.maximum(np.linalg.norm(points, axis=-1, keepdims=True), 1e-6)
        return self.apply(points + self.surface * away)

    def after(self, earlier: "CameraEstimate") -> "CameraEstimate":
        """Return this estimate, relative to a camera, in the frame and time of that camera's
        ``earlier`` estimate."""
        return CameraEstimate(
            earlier.rotation @ self.rotation,
            earlier.apply(self.translation),
            earlier.offset + self.offset,
            earlier.drift + self.drift,
        )

    def inverse(self) -> "CameraEstimate":
        """Return the estimate of the camera that this one is relative to, relative to it."""
        turned = self.rotation.T
        return CameraEstimate(turned, -turned @ self.translation, -self.offset, -self.drift)

    def angle_to(self, other: "CameraEstimate") -> float:
        """Return the angle between two rotations, radians."""
        return angle(self.rotation.T @ other.rotation)


def still() -> CameraEstimate:
    """Return the estimate of the reference camera itself."""
    return CameraEstimate(np.eye(3), np.zeros(3))


def estimate_of(pose: Pose) -> CameraEstimate:
    """Return the estimate of a camera at a pose in the reference's frame."""
    transform = of_pose(pose)
    return CameraEstimate(transform[:3, :3], transform[:3, 3])
