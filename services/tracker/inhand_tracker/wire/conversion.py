"""Messages to arrays and back."""

from collections.abc import Collection
from typing import Literal

import numpy as np
from inhand_runtime.pixels import decode_colour, decode_depth, decode_grey
from inhand_schemas.messages import Box, CameraInfo, ObjectPose, Person, Pose, RgbdFrame

from inhand_tracker.body.skeleton import without_impossible
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import Intrinsics, intrinsics_of
from inhand_tracker.geometry.estimate import Estimate
from inhand_tracker.geometry.image import Image
from inhand_tracker.wire.poses import compose, pose_message

Need = Literal["edges", "depth", "colour"]
"""What can be asked for of a frame: the terms of a likelihood, and the colours."""


def joints_of(person: Person) -> Array:
    """The joints (20, 3) in the camera frame; missing ones are NaN, and those beyond any room."""
    joints = np.array(person.joints)
    joints[[state == "missing" for state in person.states]] = np.nan
    return without_impossible(joints)


def image_of(frame: RgbdFrame, info: CameraInfo, needs: Collection[Need]) -> Image | None:
    """What is needed of a frame; None when it holds nothing of that.

    ``edges`` need its luminance. Raises MessageError for damaged pixels.
    """
    grey = frame.colour if "edges" in needs else None
    colour = frame.colour if "colour" in needs else None
    depth = frame.depth if "depth" in needs else None
    size = grey or colour or depth
    if size is None:
        return None
    return Image(
        None if grey is None else decode_grey(grey),
        intrinsics_of(info).scaled_to(size.width, size.height),
        None if depth is None else decode_depth(depth) * np.float32(info.depth_scale),
        None if colour is None else decode_colour(colour),
    )


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
    class_probabilities: dict[str, float] | None = None,
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
        class_probabilities=class_probabilities or {},
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
