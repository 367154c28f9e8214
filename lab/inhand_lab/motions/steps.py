"""Turning on the spot: feet that leave the floor one after the other, the body following."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import rotation_about
from inhand_lab.motions.timeline import minimum_jerk, track

STEP_HEIGHT = 0.05


@dataclass(frozen=True)
class Turn:
    """A turn of the body, between two times in seconds, to a heading: radians to the left."""

    start: float
    end: float
    heading: float


@dataclass(frozen=True)
class Footing:
    """Soles (T, 3), turns (T, 2) of the right and the left foot, and heading (T,) of the body."""

    right_foot: Array
    left_foot: Array
    foot_turns: Array
    heading: Array


def turn_on_the_spot(times: Array, half_width: float, turns: Sequence[Turn]) -> Footing:
    """Feet that far from the middle, turned in order of time, first the one on the inner side."""
    feet = np.zeros((2, len(times)))
    lifts = np.zeros((2, len(times)))
    keys = [(0.0, 0.0)]
    for turn in turns:
        before = keys[-1][1]
        keys += [(turn.start, before), (turn.end, turn.heading)]
        middle = 0.5 * (turn.start + turn.end)
        inner = 0 if turn.heading < before else 1
        for foot, start, end in ((inner, turn.start, middle), (1 - inner, middle, turn.end)):
            share = minimum_jerk((times - start) / (end - start))
            feet[foot] += (turn.heading - before) * share
            lifts[foot] += STEP_HEIGHT * 4.0 * share * (1.0 - share)
    right, left = (
        side * half_width * rotation_about("z", angle)[:, :, 0] + lift[:, None] * [0.0, 0.0, 1.0]
        for side, angle, lift in zip((1.0, -1.0), feet, lifts, strict=True)
    )
    return Footing(right, left, feet.T, track(times, keys))
