"""Stand-ins for joints that a body tracker never gives: people at a table, upper bodies alone.

Everything is measured from the pelvis and in body heights. Where the legs, the hips, the spine or
the hands are absent from all recordings, they are put where they usually are: hips and spine below
the shoulders, legs straight down, hands along the forearms. They say nothing then, and do no harm:
whoever is followed gets the same ones, seen or not.
"""

from collections.abc import Collection

import numpy as np
from inhand_runtime.running_medians import RunningMedians
from inhand_schemas.joints import JOINT_NAMES, SIDES, Joint

from inhand_tracker.body.parameters import DEFAULT_BODY
from inhand_tracker.body.skeleton import (
    PARTS,
    TRUNK_PARTS,
    TRUNK_SHARE,
    part_lengths,
)
from inhand_tracker.geometry.arrays import Array

REPLACEABLE = (
    Joint.HIP_CENTER,
    Joint.SPINE,
    Joint.HIP_LEFT,
    Joint.HIP_RIGHT,
    *(JOINT_NAMES.index(part + side) for part in ("Knee", "Ankle", "Foot") for side in SIDES),
    Joint.HAND_LEFT,
    Joint.HAND_RIGHT,
)
"""Joints that may be absent."""
TRUNK = (Joint.HIP_CENTER, Joint.SPINE)
HIPS = (Joint.HIP_LEFT, Joint.HIP_RIGHT)

# Lengths in body heights, as the simulated people (Drillis and Contini 1966) have them between
# Kinect's joints.
SPINE_ABOVE_HIPS = 0.051
SHOULDERS_ABOVE_SPINE = 0.230
HIP_ASIDE, HIP_BELOW = 0.054, 0.041
THIGH, SHANK, FOOT, HAND = 0.247, 0.252, 0.048, 0.041
_SHARES = {
    "Head": 0.116,
    **dict.fromkeys(("ElbowLeft", "ElbowRight"), 0.193),
    **dict.fromkeys(("WristLeft", "WristRight"), 0.156),
}
_UPPER_PARTS = [PARTS.index(name) for name in _SHARES]
_UPPER_SHARES = np.array(list(_SHARES.values()))


def seen_stature(typical: Array, absent: Collection[int]) -> float:
    """Estimate stature in metres from typical part lengths (19,) without those of absent joints.

    It is that of the trunk, or, where the trunk has no lower end, of arms and neck. NaN where none
    of these was seen.
    """
    if _are_seen(absent, *TRUNK):
        return float(typical[TRUNK_PARTS].sum() / TRUNK_SHARE)
    seen = np.isfinite(typical[_UPPER_PARTS])
    if not seen.any():
        return float("nan")
    return float(typical[_UPPER_PARTS][seen].sum() / _UPPER_SHARES[seen].sum())


def put_stand_ins(joints: Array, absent: Collection[int], height: float) -> Array:
    """Put absent joints of people (..., 20, 3) of a height in metres where they usually are."""
    placed = np.array(joints, float)
    placed[..., list(absent), :] = np.nan
    left, up, forwards = _trunk_directions(placed, absent)

    def put(joint: int, place: Array) -> None:
        if joint in absent:
            placed[..., joint, :] = place

    trunk = height * (SPINE_ABOVE_HIPS + SHOULDERS_ABOVE_SPINE)
    if _are_seen(absent, *HIPS):
        put(Joint.HIP_CENTER, placed[..., HIPS, :].mean(axis=-2) + height * HIP_BELOW * up)
    else:
        put(Joint.HIP_CENTER, placed[..., Joint.SHOULDER_CENTER, :] - trunk * up)
    hips = placed[..., Joint.HIP_CENTER, :]
    put(Joint.SPINE, hips + height * SPINE_ABOVE_HIPS * up)
    for side, sign in zip(SIDES, (1.0, -1.0), strict=True):
        hip, knee, ankle, foot, elbow, wrist, hand = (
            JOINT_NAMES.index(part + side)
            for part in ("Hip", "Knee", "Ankle", "Foot", "Elbow", "Wrist", "Hand")
        )
        put(hip, hips + height * (sign * HIP_ASIDE * left - HIP_BELOW * up))
        put(knee, placed[..., hip, :] - height * THIGH * up)
        put(ankle, placed[..., knee, :] - height * SHANK * up)
        put(foot, placed[..., ankle, :] + height * FOOT * forwards)
        forearm = _unit(placed[..., wrist, :] - placed[..., elbow, :])
        put(hand, placed[..., wrist, :] + height * HAND * forearm)
    return placed


class RunningStandIns:
    """Puts stand-ins into one person's frames, by the stature of the last frames."""

    def __init__(self, absent: Collection[int]) -> None:
        self._absent = absent
        self._medians = RunningMedians(len(PARTS), DEFAULT_BODY.height_frames)

    def put(self, joints: Array) -> Array:
        """Take one frame's joints (20, 3), and give them with stand-ins."""
        height = seen_stature(self._medians.update(part_lengths(joints)), self._absent)
        return put_stand_ins(joints, self._absent, height)


def _trunk_directions(joints: Array, absent: Collection[int]) -> tuple[Array, Array, Array]:
    """The trunk's left, up and forwards, each (..., 3), from what is seen of it."""
    chest = joints[..., Joint.SHOULDER_CENTER, :]
    if _are_seen(absent, Joint.HIP_CENTER):
        up = chest - joints[..., Joint.HIP_CENTER, :]
    elif _are_seen(absent, *HIPS):
        up = chest - joints[..., HIPS, :].mean(axis=-2)
    elif _are_seen(absent, Joint.SPINE):
        up = chest - joints[..., Joint.SPINE, :]
    else:
        # Half of the camera's upwards in it was no better, and needs a camera that stands upright.
        up = joints[..., Joint.HEAD, :] - chest
    if _are_seen(absent, *HIPS):
        left = joints[..., Joint.HIP_LEFT, :] - joints[..., Joint.HIP_RIGHT, :]
    else:
        left = joints[..., Joint.SHOULDER_LEFT, :] - joints[..., Joint.SHOULDER_RIGHT, :]
    left = _unit(left)
    up = _unit(up - np.sum(up * left, axis=-1, keepdims=True) * left)
    return left, up, np.cross(left, up)


def _are_seen(absent: Collection[int], *joints: int) -> bool:
    return not any(joint in absent for joint in joints)


def _unit(vector: Array) -> Array:
    length: Array = np.linalg.norm(vector, axis=-1, keepdims=True)
    return vector / np.maximum(length, 1e-9)
