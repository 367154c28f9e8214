"""Walking about a room with stops and turns, as people do who show themselves to cameras."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.motions.performance import Stance, hanging_hands, stand
from inhand_lab.motions.timeline import drift, minimum_jerk
from inhand_lab.people.body_motion import BodyMotion
from inhand_lab.people.kinematics import place_body, place_trunk
from inhand_lab.people.person import SimulatedPerson
from inhand_lab.world.parameters import DEFAULT_WALK
from inhand_lab.world.walking import swung


@dataclass(frozen=True)
class WanderingParameters:
    """How people walk about a room; as one does who is asked to for a minute."""

    half_width: float = 1.2
    """Half the width of the square in which they walk, metres."""
    pace: float = 0.75
    """Length of a step as a share of what it is on a long way."""
    turn_rate: float = 1.8
    """Speed of a turn at the most, radians a second."""
    turn_s: float = 0.4
    """Time constant in which a turn begins and ends, seconds."""
    speed_s: float = 0.5
    """Time constant of setting off and stopping, seconds."""
    there: float = 0.35
    """Distance from where they want to go at which they are there, metres."""
    stop_share: float = 0.35
    """Share of places where they stop."""
    stop_s: tuple[float, float] = (0.5, 2.0)
    """Time for which they stop, seconds."""
    turning_steps: float = 0.8
    """Steps a second, as a share of the walk's, in a turn on the spot at ``turn_rate``."""
    glance: float = 0.25
    """Deviation of the head's turns, radians."""
    step_s: float = 0.01
    """Step of the way's integration, seconds."""


DEFAULT_WANDERING = WanderingParameters()


@dataclass(frozen=True)
class _Way:
    """Where the body is meant to be over N steps in time: place (N, 2), heading (N,), the number
    of steps taken (N,), and the speed (N,) as a share of walking."""

    times: Array
    place: Array
    heading: Array
    steps: Array
    speed: Array

    def at(self, times: Array) -> _Way:
        """The way at other times (T,)."""
        columns = [
            np.interp(times, self.times, column)
            for column in (*self.place.T, self.heading, self.steps, self.speed)
        ]
        return _Way(times, np.stack(columns[:2], axis=1), columns[2], columns[3], columns[4])


def wander(
    person: SimulatedPerson,
    times: Array,
    random: np.random.Generator,
    parameters: WanderingParameters = DEFAULT_WANDERING,
) -> BodyMotion:
    """Walk about the world's origin at times (T,), seconds from 0 on.

    The same person and random numbers make the same movement at other times, as long as the last of
    them is the same.
    """
    way = _way(person, float(times[-1]), random, parameters)
    now = way.at(times)
    still = np.zeros((len(times), 3))
    turns = drift(times, random, parameters.glance, 4.0)
    glances = np.stack([still[:, 0], still[:, 0], turns], axis=1)
    right_foot, left_foot = (_foot(way, now.steps, side) for side in (1.0, -1.0))
    # The hips go on evenly, whichever foot is in the air.
    ahead = np.concatenate([now.place, still[:, :1]], axis=1)
    shift = (ahead - 0.5 * (right_foot + left_foot)) * [1.0, 1.0, 0.0]
    stance = Stance(right_foot, left_foot, now.heading, shift, still, glances)
    posture = stand(person, times, random, stance)
    trunk = place_trunk(person, posture)
    swing = DEFAULT_WALK.arm_swing * person.manner.amplitude * now.speed
    phase = swing * np.sin(np.pi * now.steps)
    right, left = hanging_hands(person, trunk, random)
    return place_body(
        person,
        posture,
        swung(right, trunk.right_shoulder, trunk, phase),
        swung(left, trunk.left_shoulder, trunk, -phase),
    )


def _way(
    person: SimulatedPerson, seconds: float, random: np.random.Generator, p: WanderingParameters
) -> _Way:
    """From place to place, with turns towards the next and stops at some."""
    cadence = DEFAULT_WALK.cadence * person.manner.tempo
    stride = p.pace * DEFAULT_WALK.stride * person.height / 1.75 * person.manner.amplitude
    count = int(seconds / p.step_s) + 200
    place, heading, steps = np.zeros((count, 2)), np.zeros(count), np.zeros(count)
    speeds = np.zeros(count)
    here = random.uniform(-p.half_width, p.half_width, 2)
    turn, speed, rate, taken, stop = float(random.uniform(-np.pi, np.pi)), 0.0, 0.0, 0.0, 0.0
    target = random.uniform(-p.half_width, p.half_width, 2)
    for index in range(count):
        towards = target - here
        if np.hypot(*towards) < p.there:
            target = random.uniform(-p.half_width, p.half_width, 2)
            stop = random.uniform(*p.stop_s) if random.random() < p.stop_share else 0.0
        aside = np.arctan2(-towards[0], towards[1]) - turn
        aside = float((aside + np.pi) % (2.0 * np.pi) - np.pi)
        stop = max(stop - p.step_s, 0.0)
        wanted = 0.0 if stop else max(np.cos(aside), 0.0) ** 2
        turning = 0.0 if stop else float(np.clip(aside / p.turn_s, -p.turn_rate, p.turn_rate))
        speed += (wanted - speed) * p.step_s / p.speed_s
        rate += (turning - rate) * p.step_s / (0.5 * p.turn_s)
        turn += rate * p.step_s
        here = here + cadence * stride * speed * p.step_s * np.array([-np.sin(turn), np.cos(turn)])
        taken += cadence * p.step_s * max(speed, p.turning_steps * abs(rate) / p.turn_rate)
        place[index], heading[index], steps[index], speeds[index] = here, turn, taken, speed
    return _Way(np.arange(count, dtype=float) * p.step_s, place, heading, steps, speeds)


def _foot(way: _Way, steps: Array, side: float) -> Array:
    """The sole (T, 3) of one foot after so many steps (T,): it stands, then swings to its next
    place, which is beside the body in the middle of its stand."""
    first = 0.0 if side > 0.0 else 1.0
    landings = np.arange(first - 2.0, way.steps[-1] + 4.0, 2.0)
    # Steps only rise: where they stay the first moment counts.
    rising = np.r_[True, np.diff(way.steps) > 0.0]
    moments = np.interp(landings + 0.5, way.steps[rising], way.times[rising])
    standing = way.at(moments)
    aside = side * DEFAULT_WALK.half_track
    right = np.stack([np.cos(standing.heading), np.sin(standing.heading)], axis=1)
    places = np.concatenate([standing.place + aside * right, np.zeros((len(moments), 1))], axis=1)
    sole = np.repeat(places[:1], len(steps), axis=0)
    for landing, before, after in zip(landings[1:], places, places[1:], strict=False):
        share = minimum_jerk((steps - (landing - DEFAULT_WALK.swing)) / DEFAULT_WALK.swing)
        sole += share[:, None] * (after - before)
        sole[:, 2] += DEFAULT_WALK.lift * 4.0 * share * (1.0 - share)
    return sole
