"""Reads bodies: from joints, some missing or wild, to a whole body that trackers predict from."""

from collections.abc import Collection
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from inhand_tracker.body.convention_map import ConventionMap
from inhand_tracker.body.parameters import DEFAULT_BODY, BodyParameters
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
from inhand_tracker.body.stand_ins import RunningStandIns
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array


@dataclass(frozen=True)
class Body:
    """One frame's whole body, right-handed.

    ``joints`` (20, 3) in the camera frame, ``pose`` b (60,), the basis of the ``pelvis``, and the
    person's ``height`` in metres.
    """

    joints: Array
    pose: Array
    pelvis: Bases
    height: float

    @cached_property
    def parts(self) -> Bases:
        """The 19 part predictors."""
        return part_bases(self.joints, self.pelvis)


class HasBodyPoses(Protocol):
    """Anything that keeps body poses of the people it was learned from."""

    @property
    def body_poses(self) -> Array:
        """Body poses b (N, 60)."""


class BodyReader:
    """Reads the bodies of one person, frame by frame.

    A missing joint keeps its last place in the pelvis basis; before it was ever seen it has that
    of the people who were learned from. Joints that were ``absent`` in training have stand-ins.
    Left-handed people are mirrored. Joints of another convention than ``convention``, whose the
    learned bodies are, are mapped to it (``convention_map``).
    """

    def __init__(
        self,
        learned: HasBodyPoses,
        *,
        left_handed: bool,
        absent: Collection[int] = (),
        convention: str | None = None,
        parameters: BodyParameters = DEFAULT_BODY,
    ) -> None:
        step = max(1, len(learned.body_poses) // parameters.learned_poses)
        poses = np.asarray(learned.body_poses[::step], float).reshape(-1, 20, 3)
        self._last_pose = poses.mean(axis=0)
        proportions = np.median(part_lengths(poses), axis=0)
        self._height = RunningHeight(proportions, parameters)
        self._map = ConventionMap(convention, poses, proportions, parameters)
        self._stand_ins = RunningStandIns(absent) if absent else None
        self._left_handed = left_handed
        self._farthest_joint_m = parameters.farthest_joint_m

    @property
    def trouble(self) -> str | None:
        """What is wrong with the convention of the joints; None where nothing is."""
        return self._map.trouble

    def read(self, joints: Array, convention: str | None = None) -> Body | None:
        """Read joints (20, 3) in the camera frame, missing ones NaN, of a source that says it is of
        a convention, or does not say.

        None while the pelvis is not seen or the person's height is unknown.
        """
        joints = without_impossible(joints, self._farthest_joint_m)
        joints = self._map.apply(joints, convention)
        if self._stand_ins is not None:
            joints = self._stand_ins.put(joints)
        if not has_pelvis(joints):
            return None
        if self._left_handed:
            joints = mirror_joints(joints)
        height = self._height.update(joints)
        if not np.isfinite(height):
            return None
        pelvis = pelvis_basis(joints)
        complete = self._complete(joints, pelvis, height)
        return Body(complete, self._last_pose.reshape(60), pelvis, height)

    def _complete(self, joints: Array, pelvis: Bases, height: float) -> Array:
        """Put missing joints (20, 3) where they were last."""
        seen = body_pose(joints, pelvis, height).reshape(20, 3)
        self._last_pose = np.where(np.isfinite(seen), seen, self._last_pose)
        filled = pelvis.origins + height * rotations.rotate(pelvis.rotations, self._last_pose)
        return np.where(np.isfinite(joints), joints, filled)
