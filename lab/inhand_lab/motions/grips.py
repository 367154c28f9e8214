"""How hands hold things: the hand's pose in the object's frame, object_from_hand.

A grip is constant within a person but for a slow drift, and different between people. All grips
are a right hand's; a left hand's is the mirror image.
"""

from __future__ import annotations

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import Transform, normalised, rotation_about
from inhand_lab.motions.script import Script

BAR_IN_PALM = np.array([-0.022, 0.018, 0.0])
"""Where a gripped bar passes through the fist, in the hand's frame; the bar runs along z."""

PINCH = np.array([-0.030, 0.078, 0.022])
"""Where thumb and fingertips meet, in the hand's frame."""

TURN_DRIFT, SLIDE_DRIFT, DRIFT_PERIOD = 0.05, 0.004, 6.0
"""Slow drift of a grip: radians about an axis, metres along a bar, and its period in seconds."""


def hold_bar(
    script: Script, point: Array, object_from_bar: Array, in_hand: Array = BAR_IN_PALM
) -> Transform:
    """A fist around a bar, object_from_hand (T).

    point (3,) is a place on the bar in the object's frame, and in_hand (3,) where that place is in
    the hand's; object_from_bar (3, 3) has the bar's direction to the thumb as its third column
    and, as its second, where the fingers point in a grip square to the bar. The person's
    obliqueness and the drift are added to it.
    """
    turn = script.drift(TURN_DRIFT, DRIFT_PERIOD)
    tilt = script.person.manner.grip_tilt + script.drift(TURN_DRIFT, DRIFT_PERIOD)
    slide = script.drift(SLIDE_DRIFT, DRIFT_PERIOD)
    rotation = object_from_bar @ rotation_about("xz", tilt, turn)
    along = slide[:, None] * object_from_bar[:, 2]
    return Transform(point + along - rotation @ in_hand, rotation)


def pinch(script: Script, point: Array, object_from_hand: Array) -> Transform:
    """Thumb and fingertips about a point (3,) of the object, object_from_hand (T)."""
    wobble = script.drifts(TURN_DRIFT, DRIFT_PERIOD)
    rotation = object_from_hand @ rotation_about("xyz", *wobble.T)
    return Transform(point - rotation @ PINCH, rotation)


def wrap_bar(axis: Array, point: Array, pole: Array) -> Transform:
    """A fist around a bar that may turn about it, world_from_hand (T), the fingers away from pole.

    axis (T, 3) is the bar's direction to the thumb, point and pole (T, 3) are in the world.
    """
    away = point - pole
    fingers = normalised(away - axis * np.sum(away * axis, axis=1, keepdims=True))
    rotation = np.stack([np.cross(fingers, axis), fingers, axis], axis=-1)
    return Transform(point - rotation @ BAR_IN_PALM, rotation)
