"""Reads people's recordings as a tracker would: body poses and movement features by frame."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from inhand_tracker.body.convention_map import canonical_joints
from inhand_tracker.body.reader import Body, BodyReader
from inhand_tracker.body.skeleton import (
    body_pose,
    mirror_joints,
    pelvis_basis,
    stature_of,
)
from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.recognition.arm_movement import ArmReader
from inhand_tracker.recognition.movement_window import MovementWindow
from inhand_tracker.wire.conversion import joints_of

from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.datasets.followed_people import follow_people
from inhand_lab.datasets.recorded_frames import convention_of
from inhand_lab.datasets.stretches import entry_frames
from inhand_lab.people.joint_sequence import JointSequence
from inhand_lab.training.parameters import DEFAULT_TRAINING
from inhand_lab.training.recording_checks import check_facing


@dataclass(frozen=True)
class UsualPoses:
    """Body poses (N, 60) of people, by which a reader fills in what is not seen of another one."""

    body_poses: Array


@dataclass(frozen=True)
class RecordedMovement:
    """What is learned from N bodies of a recording: their poses (N, 60), their movement features
    (N, D), and the numbers (N,) of their frames; and observations (M, 18) of the arms in all of
    it."""

    body_poses: Array
    features: Array
    arms: Array
    frames: Indices


def read_joints(dataset: Dataset, entry: DatasetEntry) -> JointSequence:
    """Read the joints of a recording's person; raises DatasetError or RecordingError.

    Bodies are canonical where their convention is tabulated.
    """
    frames = entry_frames(dataset, entry)
    joints = np.full((len(frames), 20, 3), np.nan)
    for index, followed in enumerate(follow_people(frames)):
        if followed.person is not None:
            joints[index] = joints_of(followed.person)
    check_facing(entry, joints)
    times_ns = np.array([frame.time_ns for frame in frames], np.int64)
    left_handed = entry.handedness == "left"
    joints = canonical_joints(joints, convention_of(frames))
    return JointSequence(entry.interaction, entry.participant, left_handed, joints, times_ns)


def usual_poses(people: Sequence[JointSequence]) -> UsualPoses:
    """Choose some of the whole bodies in recordings; raises DatasetError where there is none."""
    poses = [_whole_poses(one)[:: DEFAULT_TRAINING.usual_pose_step] for one in people]
    finite = [some[np.isfinite(some).all(axis=1)] for some in poses]
    if not sum(map(len, finite)):
        raise DatasetError(
            "no recording shows a whole body, and a recogniser is learned from whole ones: record "
            "so that all joints are seen"
        )
    return UsualPoses(np.concatenate(finite))


def read_bodies(sequence: JointSequence, usual: UsualPoses) -> list[Body | None]:
    """Read the bodies of T frames one after the other, as a tracker does."""
    reader = BodyReader(usual, left_handed=sequence.left_handed)
    return [reader.read(joints) for joints in sequence.joints]


def read_movement(sequence: JointSequence, usual: UsualPoses, step: int) -> RecordedMovement:
    """Read what is learned from the bodies in every ``step``-th frame, and the arms in all."""
    window, reader = MovementWindow(), ArmReader()
    poses, features, arms, frames = [], [], [], []
    for index, body in enumerate(read_bodies(sequence, usual)):
        if body is None:
            continue
        window.add(int(sequence.times_ns[index]), body.pose)
        arms += reader.read(int(sequence.times_ns[index]), body.pose)
        if index % step == 0:
            poses.append(body.pose)
            features.append(window.features())
            frames.append(index)
    numbers = np.array(frames, np.int64)
    return RecordedMovement(np.array(poses), np.array(features), np.array(arms), numbers)


def _whole_poses(sequence: JointSequence) -> Array:
    """Return the body poses (N, 60) of the frames whose joints are all seen."""
    joints = mirror_joints(sequence.joints) if sequence.left_handed else sequence.joints
    whole = joints[np.isfinite(joints).all(axis=(1, 2))]
    if not len(whole):
        return np.empty((0, 60))
    with np.errstate(invalid="ignore", divide="ignore"):
        return body_pose(whole, pelvis_basis(whole), stature_of(whole))
