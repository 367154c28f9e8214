"""Frames of the body's parts as far as a skeleton shows them.

The world is a person's: x to the right, y forward, z up. A skeleton does not show how far a
forearm is twisted or where the face looks: a hand's thumb is put where it is at rest, towards the
upper arm, and the face straight ahead of the chest.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import accumulate

import numpy as np
from inhand_schemas.joints import Joint
from inhand_tracker.geometry.arrays import Array

from inhand_lab.driven.denoising import smooth_path
from inhand_lab.driven.parameters import DEFAULT_SEEN_FRAMES
from inhand_lab.geometry.transforms import (
    MIRROR,
    Transform,
    normalised,
    rotation_about,
    rotation_from_axes,
    rotation_from_vector,
)


@dataclass(frozen=True)
class SeenFrames:
    """World_from_part over T frames, axes and origins as in kinematics.

    A foot's origin is the ankle, its y axis to the toes.
    """

    pelvis: Transform
    chest: Transform
    head: Transform
    right_hand: Transform
    left_hand: Transform
    right_foot: Transform
    left_foot: Transform


def seen_frames(joints: Array, frame_rate: float) -> SeenFrames:
    """The frames that joints (T, 20, 3) in a person's world show."""
    right_of_hips = joints[:, Joint.HIP_RIGHT] - joints[:, Joint.HIP_LEFT]
    right_of_chest = joints[:, Joint.SHOULDER_RIGHT] - joints[:, Joint.SHOULDER_LEFT]
    hips, chest = joints[:, Joint.HIP_CENTER], joints[:, Joint.SHOULDER_CENTER]
    spine, head = joints[:, Joint.SPINE], joints[:, Joint.HEAD]
    right_arm = joints[:, Joint.SHOULDER_RIGHT : Joint.HAND_RIGHT + 1]
    left_arm = joints[:, Joint.SHOULDER_LEFT : Joint.HAND_LEFT + 1] * MIRROR
    return SeenFrames(
        Transform(hips, _upright(spine - hips, right_of_hips)),
        Transform(chest, _upright(chest - spine, right_of_chest)),
        Transform(head, _upright(head - chest, right_of_chest)),
        _hand(right_arm, right_of_chest, frame_rate),
        _hand(left_arm, -right_of_chest * MIRROR, frame_rate).mirrored(),
        _foot(joints, Joint.KNEE_RIGHT),
        _foot(joints, Joint.KNEE_LEFT),
    )


def _upright(up: Array, right: Array) -> Array:
    """Rotations (T, 3, 3) with z along up and x as near to the right as that allows."""
    z = normalised(up)
    x = normalised(right - z * np.sum(right * z, axis=1, keepdims=True))
    return np.stack([x, np.cross(z, x), z], axis=2)


def _hand(arm: Array, aside: Array, frame_rate: float) -> Transform:
    """The palm's frame of a right arm (T, 4, 3) from shoulder to hand.

    Where the elbow is nearly straight the thumb turns to where it is with the elbow below; and it
    never turns faster about the fingers than forearms do.
    """
    shoulder, elbow, wrist, hand = np.moveaxis(arm, 1, 0)
    fingers = normalised(
        normalised(wrist - elbow) + DEFAULT_SEEN_FRAMES.hand_share * normalised(hand - wrist)
    )
    thumb = normalised(shoulder - elbow) + DEFAULT_SEEN_FRAMES.straight * np.cross(
        normalised(aside), fingers
    )
    palm = np.linalg.norm(hand - wrist, axis=1, keepdims=True)
    rotation = _rolled(_carried(fingers, thumb[0]), thumb, frame_rate)
    return Transform(wrist + palm * fingers, rotation)


def _carried(fingers: Array, thumb: Array) -> Array:
    """Rotations (T, 3, 3) with y along fingers (T, 3), from each to the next the shortest way.

    The first one's z axis leans towards the thumb (3,).
    """
    ways = np.cross(fingers[:-1], fingers[1:])
    sines = np.linalg.norm(ways, axis=1, keepdims=True)
    angles = np.arctan2(sines[:, 0], np.sum(fingers[:-1] * fingers[1:], axis=1))
    steps = rotation_from_vector(ways / np.maximum(sines, 1e-9) * angles[:, None])
    first = rotation_from_axes(fingers[0], thumb)
    return np.stack(list(accumulate(steps, lambda here, step: step @ here, initial=first)))


def _rolled(frames: Array, thumb: Array, frame_rate: float) -> Array:
    """Frames (T, 3, 3) turned about y until z leans towards the thumb (T, 3), but smoothly."""
    x, z = (np.sum(frames[:, :, axis] * thumb, axis=1) for axis in (0, 2))
    roll = np.unwrap(np.arctan2(x, z))[:, None]
    cut_off = DEFAULT_SEEN_FRAMES.roll_cut_off / frame_rate
    smooth = smooth_path(roll, np.minimum(x**2 + z**2, 1.0), cut_off)
    return np.asarray(frames @ rotation_about("y", smooth[:, 0]))


def _foot(joints: Array, knee: Joint) -> Transform:
    ankle = joints[:, knee + 1]
    y = normalised(joints[:, knee + 2] - ankle)
    x = normalised(np.cross(y, joints[:, knee] - ankle))
    return Transform(ankle, np.stack([x, y, np.cross(x, y)], axis=2))
