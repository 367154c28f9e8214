"""Poses as messages: rigid transforms, and an object's estimate with all that goes with it."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from inhand_schemas.messages import Box, ObjectPose, Pose
from inhand_schemas.procedures import MOST_HYPOTHESES, ObjectHypotheses

from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.considered import Considered
from inhand_tracker.geometry.estimate import Estimate


@dataclass(frozen=True)
class SourceFrame:
    """The frame that an estimate was made from, and its camera's place in the rig, if known."""

    sequence: int
    time_ns: int
    camera: str
    rig_from_camera: Pose | None = None


def object_pose_message(
    estimate: Estimate,
    source: SourceFrame,
    *,
    name: str,
    person: int | None,
    box: Box | None = None,
    class_probabilities: Mapping[str, float] | None = None,
) -> ObjectPose:
    """Write the estimate of the object ``name`` that a person uses as a message."""
    pose = rig_pose = covariance = None
    if estimate.translation is not None and estimate.rotation is not None:
        pose = pose_message(estimate.translation, estimate.rotation)
        if source.rig_from_camera is not None:
            rig_pose = compose(source.rig_from_camera, pose)
    if estimate.covariance is not None:
        covariance = tuple(estimate.covariance.ravel().tolist())
    return ObjectPose(
        sequence=source.sequence,
        time_ns=source.time_ns,
        object=name,
        camera=source.camera,
        state=estimate.state,
        confidence=estimate.confidence,
        person=person,
        camera_from_object=pose,
        rig_from_object=rig_pose,
        covariance=covariance,
        box=box,
        class_probabilities=dict(class_probabilities or {}),
    )


def hypotheses_message(
    considered: Considered, *, name: str, person: int | None
) -> ObjectHypotheses:
    """Write what was considered of the object ``name`` that a person uses as a part of a message.

    Only the likeliest hypotheses are told where there are many, and nothing that is not finite.
    """
    poses = np.concatenate((considered.translations, considered.rotations), axis=1)
    likeliest = np.argsort(-considered.weights, kind="stable")[:MOST_HYPOTHESES]
    told = likeliest[np.isfinite(poses[likeliest]).all(axis=1)]
    return ObjectHypotheses(
        object=name,
        person=person,
        poses=tuple(pose_message(pose[:3], pose[3:]) for pose in poses[told]),
        weights=tuple(np.clip(considered.weights[told], 0.0, 1.0).tolist()),
        predictions={
            part: pose_message(*pose)
            for part, pose in considered.predictions.items()
            if np.isfinite(np.concatenate(pose)).all()
        },
    )


def image_box(outline: Array | None, camera: Intrinsics) -> Box | None:
    """Find the part of the image that holds an outline's pixels (B, 2).

    None where there is no outline, a point of it is behind the camera, or none is inside.
    """
    if outline is None or not np.isfinite(outline).all():
        return None
    left, top = np.maximum(outline.min(axis=0), 0.0).tolist()
    right, bottom = np.minimum(outline.max(axis=0), [camera.width, camera.height]).tolist()
    if right <= left or bottom <= top:
        return None
    return Box(left, top, right - left, bottom - top)


def pose_message(translation: Array, rotation: Array) -> Pose:
    """Write a transform, (3,) and (4,), as a message."""
    x, y, z = translation.tolist()
    a, b, c, d = rotations.normalise(rotation).tolist()
    return Pose((x, y, z), (a, b, c, d))


def compose(first: Pose, second: Pose) -> Pose:
    """Chain two transforms: rig_from_camera and camera_from_object give rig_from_object."""
    rotation = np.array(first.rotation)
    moved = rotations.rotate(rotation, np.array(second.translation)) + first.translation
    return pose_message(moved, rotations.multiply(rotation, np.array(second.rotation)))
