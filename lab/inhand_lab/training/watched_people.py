"""People as a recogniser sees them: body poses frame by frame, read as the tracker reads them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from inhand_tracker.body.reader import Body, BodyReader
from inhand_tracker.body.skeleton import (
    body_pose,
    mirror_joints,
    part_lengths,
    pelvis_basis,
    stature,
)
from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.people.following import PersonFollower
from inhand_tracker.recognition.movement_window import MovementWindow
from inhand_tracker.wire.conversion import joints_of

from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.datasets.recorded_frames import load_frames
from inhand_lab.people.joint_sequence import JointSequence

USUAL_STEP = 10


@dataclass(frozen=True)
class UsualPoses:
    """Body poses (N, 60) of people, for a reader to fill in what is not seen of another one."""

    body_poses: Array


def watch(dataset: Dataset, entry: DatasetEntry) -> JointSequence:
    """A recording as its person was seen; raises DatasetError or RecordingError."""
    frames = load_frames(dataset.path(entry), entry.object)
    joints = np.full((len(frames), 20, 3), np.nan)
    follower = PersonFollower()
    for index, frame in enumerate(frames):
        person = follower.choose(frame.people, frame.time_ns)
        if person is not None:
            joints[index] = joints_of(person)
    times = np.array([frame.time_ns for frame in frames], np.int64)
    return JointSequence(
        entry.interaction, entry.participant, entry.handedness == "left", joints, times
    )


def usual_poses(people: Sequence[JointSequence]) -> UsualPoses:
    """Some of the whole bodies in recordings; raises DatasetError where there is none."""
    found = []
    for one in people:
        joints = mirror_joints(one.joints) if one.left_handed else one.joints
        whole = joints[np.isfinite(joints).all(axis=(1, 2))]
        if len(whole):
            height = stature(part_lengths(whole))
            with np.errstate(invalid="ignore", divide="ignore"):
                poses = body_pose(whole, pelvis_basis(whole), height)[::USUAL_STEP]
            found.append(poses[np.isfinite(poses).all(axis=1)])
    if not sum(map(len, found)):
        raise DatasetError("no recording shows a whole body: nothing can be learned from them")
    return UsualPoses(np.concatenate(found))


def read_bodies(one: JointSequence, usual: UsualPoses) -> list[Body | None]:
    """The bodies of T frames, as a tracker reads them one after the other."""
    reader = BodyReader(usual, left_handed=one.left_handed)
    return [reader.read(joints) for joints in one.joints]


def poses_and_movements(
    one: JointSequence, usual: UsualPoses, step: int = 1
) -> tuple[Array, Array, Indices]:
    """Body poses (N, 60), movement features (N, D) and frames (N,) of every so many-th body."""
    movement = MovementWindow()
    poses, features, frames = [], [], []
    for index, body in enumerate(read_bodies(one, usual)):
        if body is None:
            continue
        movement.add(int(one.times_ns[index]), body.pose)
        if index % step == 0:
            poses.append(body.pose)
            features.append(movement.features())
            frames.append(index)
    return np.array(poses), np.array(features), np.array(frames, np.int64)
