"""What arms can reach."""

from __future__ import annotations

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import Transform
from inhand_lab.people.kinematics import Trunk
from inhand_lab.people.person import SimulatedPerson

STRETCH = 0.99
"""Furthest distance of shoulder and wrist as a share of the arm's length."""
ROUNDS = 8
"""Number of times that a thing is moved towards one arm and then the other."""


def overreach(person: SimulatedPerson, shoulder: Array, hand: Transform) -> Array:
    """How (T, 3), in metres, a hand (T) must move for its wrist to come within reach."""
    body = person.proportions
    wrist = hand.translation - hand.rotation[:, :, 1] * body.palm
    offset = shoulder - wrist
    distance = np.linalg.norm(offset, axis=1, keepdims=True)
    excess = np.clip(distance - STRETCH * (body.upper_arm + body.forearm), 0.0, None)
    return np.asarray(offset * (excess / distance))


def within_both_reaches(
    person: SimulatedPerson,
    trunk: Trunk,
    held: Transform,
    grips: tuple[Transform, Transform],
) -> Transform:
    """A thing held with both hands (T), moved no further than both arms need to reach it.

    The grips, of the right and the left hand, are object_from_hand (T).
    """
    for _ in range(ROUNDS):
        for shoulder, grip in zip((trunk.right_shoulder, trunk.left_shoulder), grips, strict=True):
            shift = overreach(person, shoulder, held @ grip)
            held = Transform(held.translation + shift, held.rotation)
    return held
