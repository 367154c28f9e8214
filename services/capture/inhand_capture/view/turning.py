"""A camera that hangs upside down or on its side, turned by quarters clockwise.

The camera frame turns with its picture about the view's axis: x stays right, y down and z forward.
"""

import math
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from inhand_runtime.source import SourceError
from inhand_schemas.fields import Quaternion, Vector3
from inhand_schemas.messages import Box, CameraInfo, ObjectPose, Person, Pose
from msgspec.structs import replace
from numpy.typing import NDArray

P = TypeVar("P", bound=np.generic)
QUARTER: Quaternion = (math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5))
"""Rotation of points by a quarter about z."""
BACK: Quaternion = (math.sqrt(0.5), 0.0, 0.0, -math.sqrt(0.5))
AXES: tuple[Vector3, ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
TILTS = slice(12, 14)
"""Where OpenCV's distortion coefficients hold the tilt of the sensor."""


@dataclass(frozen=True)
class Turn:
    """So many quarters clockwise, of pictures of a source's ``width`` × ``height``."""

    quarters: int
    width: int
    height: int

    def picture(self, pixels: NDArray[P]) -> NDArray[P]:
        """(H, W, …) turned."""
        return np.ascontiguousarray(np.rot90(pixels, -self.quarters))

    def back(self, pixels: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """(H, W) of a turned picture as the source's."""
        return np.rot90(pixels, self.quarters)

    def info(self, info: CameraInfo) -> CameraInfo:
        """How the turned camera sees; raises SourceError where the sensor is tilted in its lens."""
        if any(info.distortion[TILTS]) and self.quarters:
            raise SourceError(
                "rotate cannot be used with this camera's distortion, which has a tilted sensor: "
                "undistort its pictures first, or leave rotate out"
            )
        for _ in range(self.quarters):
            info = _quarter_info(info)
        return info

    def person(self, person: Person) -> Person:
        """A skeleton in the turned camera's frame."""
        return replace(person, joints=tuple(map(self.point, person.joints)))

    def label(self, label: ObjectPose) -> ObjectPose:
        """A pose, its covariance, box and joints as the turned camera sees them."""
        pose, box, covariance = label.camera_from_object, label.box, label.covariance
        height, width = self.height, self.width
        for _ in range(self.quarters):
            pose = None if pose is None else _quarter_pose(pose)
            box = None if box is None else _quarter_box(box, height)
            height, width = width, height
        joints = label.person_joints
        return replace(
            label,
            camera_from_object=pose,
            box=box,
            covariance=None if covariance is None else self._covariance(covariance),
            person_joints=None if joints is None else tuple(map(self.point, joints)),
        )

    def point(self, point: Vector3) -> Vector3:
        """A point in the turned camera's frame."""
        for _ in range(self.quarters):
            point = _quarter_point(point)
        return point

    def _covariance(self, covariance: tuple[float, ...]) -> tuple[float, ...]:
        """6 × 6 row by row: both of its halves turn with the camera's frame."""
        rotation = np.array([self.point(axis) for axis in AXES]).T
        both = np.kron(np.eye(2), rotation)
        return tuple((both @ np.reshape(covariance, (6, 6)) @ both.T).ravel().tolist())


def _quarter_info(info: CameraInfo) -> CameraInfo:
    mount = info.rig_from_camera
    return replace(
        info,
        width=info.height,
        height=info.width,
        fx=info.fy,
        fy=info.fx,
        cx=info.height - 1 - info.cy,
        cy=info.cx,
        distortion=_quarter_distortion(info.distortion),
        rig_from_camera=Pose(mount.translation, _product(mount.rotation, BACK)),
    )


def _quarter_distortion(coefficients: tuple[float, ...]) -> tuple[float, ...]:
    """Turn OpenCV's coefficients: k1 k2 p1 p2 k3 k4 k5 k6 s1 s2 s3 s4 τx τy, as far as given."""
    turned = list(coefficients)
    if len(turned) >= 4:
        p1, p2 = turned[2:4]
        turned[2:4] = (p2, -p1)
    if len(turned) >= 12:
        s1, s2, s3, s4 = turned[8:12]
        turned[8:12] = (-s3, -s4, s1, s2)
    return tuple(turned)


def _quarter_point(point: Vector3) -> Vector3:
    x, y, z = point
    return (-y, x, z)


def _quarter_pose(pose: Pose) -> Pose:
    return Pose(_quarter_point(pose.translation), _product(QUARTER, pose.rotation))


def _quarter_box(box: Box, height: int) -> Box:
    """A rectangle of a picture of that height."""
    return Box(height - 1 - box.top - box.height, box.left, box.height, box.width)


def _product(a: Quaternion, b: Quaternion) -> Quaternion:
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return (
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    )
