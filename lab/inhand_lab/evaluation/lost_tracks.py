"""When a track, or the body that it hangs on, is lost, and how long until it is found again.

A track is lost from the frame in which the vertex error exceeds 20 cm, or no pose is given, until
the error is below 10 cm again. The body is lost while the tracker's person has no pelvis or, where
the true joints are known, while a joint above the legs is more than 20 cm from its place.
"""

from dataclasses import dataclass

import numpy as np
from inhand_schemas.joints import JOINT_NAMES
from inhand_tracker.body.skeleton import has_pelvis
from inhand_tracker.geometry.arrays import Array, Flags, Indices

LOST_M = 0.20
FOUND_M = 0.10
BODY_LOST_M = 0.20

_UPPER_JOINTS = np.array(
    [
        joint
        for joint, name in enumerate(JOINT_NAMES)
        if not name.startswith(("Knee", "Ankle", "Foot"))
    ]
)


@dataclass(frozen=True)
class Recoveries:
    """How many times something was lost, and the seconds until found, all together.

    What is not found again counts until the end of the recording.
    """

    losses: int
    seconds: float


def lost_frames(vertex_errors: Array, given: Flags) -> Flags:
    """(T,): in which frames the track is lost, of its errors in metres and where poses are given.

    An error that is NaN, before the first pose, is a loss.
    """
    lost = np.empty(len(vertex_errors), bool)
    now = False
    for frame, (error, there) in enumerate(zip(vertex_errors, given, strict=True)):
        limit = FOUND_M if now else LOST_M
        now = not (there and error <= limit)
        lost[frame] = now
    return lost


def lost_bodies(joints: Array, true_joints: Array) -> Flags:
    """(T,): in which frames the body is lost, of joints (T, 20, 3) seen and true, NaN unknown."""
    without_pelvis = np.array([not has_pelvis(frame) for frame in joints], bool)
    off = np.linalg.norm(joints - true_joints, axis=-1)[:, _UPPER_JOINTS]
    return without_pelvis | (np.nan_to_num(off) > BODY_LOST_M).any(axis=1)


def recoveries(lost: Flags, times_ns: Indices) -> Recoveries:
    """Of the stretches in which a track is lost."""
    starts, ends = _stretches(lost)
    return _sum(_ends_of_frames(times_ns)[ends] - times_ns[starts])


def recoveries_after(body_lost: Flags, lost: Flags, times_ns: Indices) -> Recoveries:
    """From the first frame in which the body is right again to the first with the track found."""
    _, ends = _stretches(body_lost)
    ends = ends[ends < len(lost)]
    found = np.append(np.flatnonzero(~lost), len(lost))
    back = found[np.searchsorted(found, ends)]
    times = _ends_of_frames(times_ns)
    return _sum(times[back] - times[ends])


def _stretches(flags: Flags) -> tuple[Indices, Indices]:
    """First frames of the stretches, and the frames after their last."""
    padded = np.concatenate(([False], flags, [False])).astype(np.int8)
    changes = np.flatnonzero(np.diff(padded))
    return changes[::2], changes[1::2]


def _ends_of_frames(times_ns: Indices) -> Indices:
    """The times, and one more: when a frame after the last would come."""
    step = int(np.median(np.diff(times_ns))) if len(times_ns) > 1 else 0
    return np.append(times_ns, times_ns[-1:] + step)


def _sum(durations_ns: Indices) -> Recoveries:
    return Recoveries(len(durations_ns), float(durations_ns.sum()) / 1e9)
