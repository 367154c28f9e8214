"""Messages to arrays and back."""

import numpy as np
from inhand_schemas.messages import Box, ObjectPose, Person, Pose
from numpy.typing import NDArray

from inhand_tracker import rotations
from inhand_tracker.camera import Intrinsics
from inhand_tracker.estimate import Estimate

Array = NDArray[np.float64]

FARTHEST_M = 1000.0


def joints_of(person: Person) -> Array:
    """The joints (20, 3) in the camera frame; missing ones are NaN, and those beyond any room."""
    joints = np.array(person.joints)
    joints[[state == "missing" for state in person.states]] = np.nan
    joints[(np.abs(joints) > FARTHEST_M).any(axis=1)] = np.nan
    return joints


def pose_message(translation: Array, rotation: Array) -> Pose:
    """A transform as a message: (3,) and (4,)."""
    x, y, z = translation.tolist()
    a, b, c, d = rotations.normalise(rotation).tolist()
    return Pose((x, y, z), (a, b, c, d))


def compose(first: Pose, second: Pose) -> Pose:
    """``second``, then ``first``: rig_from_camera, camera_from_object → rig_from_object."""
    rotation = np.array(first.rotation)
    moved = rotations.rotate(rotation, np.array(second.translation)) + first.translation
    return pose_message(moved, rotations.multiply(rotation, np.array(second.rotation)))


def object_pose_message(
    estimate: Estimate,
    *,
    sequence: int,
    time_ns: int,
    name: str,
    camera: str,
    person: int | None,
    rig_from_camera: Pose | None,
    box: Box | None,
) -> ObjectPose:
    """An estimate as a message; ``sequence`` and ``time_ns`` are the source frame's."""
    pose = None
    if estimate.translation is not None and estimate.rotation is not None:
        pose = pose_message(estimate.translation, estimate.rotation)
    return ObjectPose(
        sequence=sequence,
        time_ns=time_ns,
        object=name,
        camera=camera,
        state=estimate.state,
        confidence=estimate.confidence,
        person=person,
        camera_from_object=pose,
        rig_from_object=None
        if pose is None or rig_from_camera is None
        else compose(rig_from_camera, pose),
        covariance=None
        if estimate.covariance is None
        else tuple(estimate.covariance.ravel().tolist()),
        box=box,
    )


def box_around(outline: Array | None, camera: Intrinsics) -> Box | None:
    """The part of the image that holds the pixels (B, 2); None when none is inside."""
    if outline is None or not np.isfinite(outline).all():
        return None
    left, top = np.maximum(outline.min(axis=0), 0.0).tolist()
    right, bottom = np.minimum(outline.max(axis=0), [camera.width, camera.height]).tolist()
    if right <= left or bottom <= top:
        return None
    return Box(left, top, right - left, bottom - top)
