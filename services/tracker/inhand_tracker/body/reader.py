"""From a person's joints, of which some may be missing or wild, to what a tracker predicts from."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from inhand_tracker.body.skeleton import (
    Bases,
    RunningHeight,
    body_pose,
    has_pelvis,
    mirror_joints,
    part_bases,
    part_lengths,
    pelvis_basis,
    without_impossible,
)
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array

LEARNED_FRAMES = 1000


@dataclass(frozen=True)
class Body:
    """One frame's body, right-handed: all joints (20, 3) in the camera frame, b (60,), the 19 part
    predictors, and the height."""

    joints: Array
    pose: Array
    parts: Bases
    height: float


class Learned(Protocol):
    """Anything that was learned from people, of whom it keeps body poses b (N, 60)."""

    @property
    def body_poses(self) -> Array:
        """(N, 60)."""


class BodyReader:
    """Reads the bodies of one person, frame by frame.

    A missing joint keeps its last place in the pelvis basis, and at first that of the people that
    was learned from. Left-handed people are mirrored.
    """

    def __init__(self, learned: Learned, *, left_handed: bool) -> None:
        step = max(1, len(learned.body_poses) // LEARNED_FRAMES)
        poses = np.asarray(learned.body_poses[::step], float).reshape(-1, 20, 3)
        self._known_pose = poses.mean(axis=0)
        self._height = RunningHeight(np.median(part_lengths(poses), axis=0))
        self._left_handed = left_handed

    def read(self, joints: Array) -> Body | None:
        """The body of joints (20, 3) in the camera frame, missing ones NaN.

        None while the pelvis is not seen or the person's height is not known.
        """
        joints = without_impossible(joints)
        if not has_pelvis(joints):
            return None
        if self._left_handed:
            joints = mirror_joints(joints)
        height = self._height.update(joints)
        if not np.isfinite(height):
            return None
        pelvis = pelvis_basis(joints)
        seen = body_pose(joints, pelvis, height).reshape(20, 3)
        self._known_pose = np.where(np.isfinite(seen), seen, self._known_pose)
        filled = pelvis.origins + height * rotations.rotate(pelvis.rotations, self._known_pose)
        complete = np.where(np.isfinite(joints), joints, filled)
        return Body(complete, self._known_pose.reshape(60), part_bases(complete, pelvis), height)
