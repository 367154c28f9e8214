"""Finds when a track, or the body that it hangs on, is lost, and how long until it is found again.

A track is lost from the frame in which the vertex error exceeds 20 cm, or no pose is given, until
the error is below 10 cm again. The body is lost while the tracker's person has no pelvis or, where
the true joints are known, while a joint above the legs is more than 20 cm from its place.
"""

from dataclasses import dataclass

import numpy as np
from inhand_schemas.joints import JOINT_NAMES
from inhand_tracker.body.skeleton import has_pelvis
from inhand_tracker.geometry.arrays import Array, Flags, Indices

from inhand_lab.evaluation.parameters import DEFAULT_EVALUATION, EvaluationParameters

_UPPER_JOINTS = np.array(
    [
        joint
        for joint, name in enumerate(JOINT_NAMES)
        if not name.startswith(("Knee", "Ankle", "Foot"))
    ]
)


@dataclass(frozen=True)
class Recoveries:
    """Number of times that something was lost, and the sum of the seconds until it was found.

    What is not found again counts until the end of the recording.
    """

    losses: int
    seconds: float


def lost_frames(
    vertex_errors: Array, given: Flags, parameters: EvaluationParameters = DEFAULT_EVALUATION
) -> Flags:
    """Flag (T,) the frames in which a track is lost.

    ``vertex_errors`` (T,) are in metres, and NaN before the first pose, which is a loss; ``given``
    (T,) flags the frames with a pose.
    """
    lost = np.empty(len(vertex_errors), bool)
    before = False
    for frame, (error, has_pose) in enumerate(zip(vertex_errors, given, strict=True)):
        limit = parameters.found_m if before else parameters.lost_m
        lost[frame] = before = not (has_pose and error <= limit)
    return lost


def lost_bodies(
    joints: Array, true_joints: Array, parameters: EvaluationParameters = DEFAULT_EVALUATION
) -> Flags:
    """Flag (T,) the frames in which the body is lost.

    Both ``joints``, as they were seen, and ``true_joints`` are (T, 20, 3), NaN where unknown.
    """
    without_pelvis = np.array([not has_pelvis(frame) for frame in joints], bool)
    off = np.linalg.norm(joints - true_joints, axis=-1)[:, _UPPER_JOINTS]
    return without_pelvis | (np.nan_to_num(off) > parameters.body_lost_m).any(axis=1)


def recoveries(lost: Flags, times_ns: Indices) -> Recoveries:
    """Sum up the stretches in which a track is lost."""
    starts, ends = _stretches(lost)
    return _sum(_ends_of_frames(times_ns)[ends] - times_ns[starts])


def recoveries_after(body_lost: Flags, lost: Flags, times_ns: Indices) -> Recoveries:
    """Sum up the times from when the body is right again until the track is found.

    Each begins with the first frame of a right body, and ends with the first of a found track.
    """
    _, ends = _stretches(body_lost)
    ends = ends[ends < len(lost)]
    tracked = np.append(np.flatnonzero(~lost), len(lost))
    back = tracked[np.searchsorted(tracked, ends)]
    times = _ends_of_frames(times_ns)
    return _sum(times[back] - times[ends])


def _stretches(flags: Flags) -> tuple[Indices, Indices]:
    """Return the first frames of the stretches of flags, and the frames after their last."""
    padded = np.concatenate(([False], flags, [False])).astype(np.int8)
    changes = np.flatnonzero(np.diff(padded))
    return changes[::2], changes[1::2]


def _ends_of_frames(times_ns: Indices) -> Indices:
    """Return the frames' times, and one more: when a frame after the last would come."""
    step = int(np.median(np.diff(times_ns))) if len(times_ns) > 1 else 0
    return np.append(times_ns, times_ns[-1:] + step)


def _sum(durations_ns: Indices) -> Recoveries:
    return Recoveries(len(durations_ns), float(durations_ns.sum()) / 1e9)
