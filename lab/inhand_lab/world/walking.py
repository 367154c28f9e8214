"""Walking on the spot or in a circle: where the feet are, and how the arms swing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import Transform, rotation_about
from inhand_lab.motions.performance import Stance, hanging_hands, heading_of, stand
from inhand_lab.motions.timeline import minimum_jerk
from inhand_lab.people.body_motion import BodyMotion
from inhand_lab.people.kinematics import Trunk, place_body, place_trunk
from inhand_lab.people.person import SimulatedPerson
from inhand_lab.world.parameters import DEFAULT_WALK


@dataclass(frozen=True)
class Walk:
    """A way that somebody walks, on the spot where the radius is 0.

    ``pace`` is steps a second, ``speed`` metres a second; the circle of that ``radius``, metres,
    about the world's origin begins at the angle ``start``, radians, and goes to the left where
    ``way`` is 1, to the right where it is -1.
    """

    pace: float
    speed: float
    radius: float
    start: float
    way: float

    def heading(self, way_gone: Array) -> Array:
        """The body's turns (T,) to the left after so many metres (T,), radians."""
        if not self.radius:
            return np.zeros(len(way_gone))
        return self.start + self.way * (way_gone / self.radius) + (np.pi if self.way < 0.0 else 0.0)

    def foot(self, times: Array, side: float) -> Array:
        """The sole (T, 3) of one foot: it stands, then swings past the other to its next place."""
        swing = DEFAULT_WALK.swing / self.pace
        first = 0.0 if side > 0.0 else 1.0 / self.pace
        landings = np.arange(first - 2.0 / self.pace, times[-1] + 4.0 / self.pace, 2.0 / self.pace)
        places = np.array(
            [self._place(self.speed * (landing + 0.5 / self.pace), side) for landing in landings]
        )
        sole = np.repeat(places[:1], len(times), axis=0)
        for landing, before, after in zip(landings[1:], places, places[1:], strict=False):
            share = minimum_jerk((times - (landing - swing)) / swing)
            sole += share[:, None] * (after - before)
            sole[:, 2] += DEFAULT_WALK.lift * 4.0 * share * (1.0 - share)
        return sole

    def _place(self, way_gone: float, side: float) -> Array:
        """Where a foot stands when the body has gone so many metres."""
        aside = DEFAULT_WALK.half_track * side
        if not self.radius:
            return np.array([aside, 0.0, 0.0])
        turn = float(self.heading(np.array([way_gone]))[0])
        right = np.array([np.cos(turn), np.sin(turn), 0.0])
        return right * (self.radius * self.way + aside)


def walk(
    person: SimulatedPerson, times: Array, random: np.random.Generator, radius: float
) -> BodyMotion:
    """Walk on the spot, where the radius is 0, or in a circle about the world's origin."""
    pace = DEFAULT_WALK.cadence * person.manner.tempo
    stride = DEFAULT_WALK.stride * person.height / 1.75 * person.manner.amplitude
    speed = pace * stride if radius else 0.0
    start, way = random.uniform(0.0, 2.0 * np.pi), float(random.choice([-1.0, 1.0]))
    walked = Walk(pace, speed, radius, start, way)
    right_foot, left_foot = (walked.foot(times, side) for side in (1.0, -1.0))
    still = np.zeros((len(times), 3))
    stance = Stance(right_foot, left_foot, walked.heading(times * speed), still, still, still)
    posture = stand(person, times, random, stance)
    trunk = place_trunk(person, posture)
    phase = DEFAULT_WALK.arm_swing * person.manner.amplitude * np.sin(np.pi * pace * times)
    right, left = hanging_hands(person, trunk, random)
    return place_body(
        person,
        posture,
        swung(right, trunk.right_shoulder, trunk, phase),
        swung(left, trunk.left_shoulder, trunk, -phase),
    )


def swung(hand: Transform, shoulder: Array, trunk: Trunk, angle: Array) -> Transform:
    """A hanging hand turned forwards about its shoulder by angles (T,)."""
    upright = rotation_about("z", heading_of(trunk.world_from_chest))
    turn = upright @ rotation_about("x", angle) @ np.swapaxes(upright, 1, 2)
    offset = (turn @ (hand.translation - shoulder)[..., None])[..., 0]
    return Transform(shoulder + offset, turn @ hand.rotation)
