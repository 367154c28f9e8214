"""Stages of an interaction in time, and smooth movement through key poses.

Movement between rests is minimum-jerk (Flash & Hogan, 1985).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from inhand_tracker.geometry.arrays import Array, Flags
from numpy.typing import ArrayLike
from scipy.interpolate import PchipInterpolator

from inhand_lab.geometry.transforms import Transform, interpolate
from inhand_lab.people.person import SimulatedPerson

JITTER = 0.10
"""Standard deviation of the duration of one movement between repetitions."""

SHORTEST_PAUSE = 0.4
"""A pause is at least this share of its usual duration."""


@dataclass(frozen=True)
class Move:
    """A stage in which something moves; its duration is for a person of average tempo.

    Nobody stops in the middle of a ``swift`` one.
    """

    name: str
    seconds: float
    swift: bool = False


@dataclass(frozen=True)
class Pause:
    """A stage of rest: whatever time the movements leave goes to the pauses."""

    name: str
    seconds: float


Step = Move | Pause


@dataclass(frozen=True)
class Plan:
    """The steps of an interaction: how a thing is taken, each round of its use, the way back.

    ``on_stool`` says whether it can as well be done on a stool.
    """

    opening: Sequence[Step]
    use: Sequence[Step]
    closing: Sequence[Step]
    on_stool: bool = False


@dataclass(frozen=True)
class Stage:
    """A stage with its place in time, in seconds; repetition counts the rounds of use from 0.

    A ``breakable`` one may be interrupted or broken off; a ``swift`` one is done to its end.
    """

    name: str
    repetition: int
    start: float
    end: float
    breakable: bool = False
    swift: bool = False

    @property
    def seconds(self) -> float:
        """Its duration."""
        return self.end - self.start

    def at(self, share: float) -> float:
        """The time, in seconds, when that share of the stage is over."""
        return self.start + share * (self.end - self.start)

    def part(self, first: float, last: float) -> Stage:
        """What is between two shares of it."""
        return replace(self, start=self.at(first), end=self.at(last))


def schedule(
    person: SimulatedPerson, random: np.random.Generator, duration: float, plan: Plan
) -> list[Stage]:
    """Stages that fill the duration, in seconds: opening, as many uses as fit, closing."""

    def timed(steps: Sequence[Step]) -> list[Step]:
        return _timed(person, random, steps)

    opening, closing, rounds = timed(plan.opening), timed(plan.closing), [timed(plan.use)]
    used = _least(opening) + _least(closing) + _least(rounds[0])
    while used + _least(following := timed(plan.use)) < duration:
        rounds.append(following)
        used += _least(following)
    steps = [
        *((0, step) for step in opening),
        *((number, step) for number, steps in enumerate(rounds) for step in steps),
        *((len(rounds) - 1, step) for step in closing),
    ]
    bounds = np.cumsum([0.0, *_fill([step for _, step in steps], duration)])
    return [
        Stage(
            step.name,
            repetition,
            float(start),
            float(end),
            breakable=isinstance(step, Move) and not step.swift,
            swift=isinstance(step, Move) and step.swift,
        )
        for (repetition, step), (start, end) in zip(steps, pairwise(bounds), strict=True)
    ]


def spare_time(person: SimulatedPerson, duration: float, plan: Plan) -> float:
    """Seconds of the duration that a plan with two rounds of use leaves, at the person's tempo."""
    steps = [*plan.opening, *plan.use, *plan.use, *plan.closing]
    pace = _pace(person)
    usual = [replace(step, seconds=step.seconds * pace[type(step)]) for step in steps]
    return max(duration - _least(usual), 0.0)


def _pace(person: SimulatedPerson) -> dict[type[Step], float]:
    """Factors on the durations of pauses and moves."""
    return {Pause: person.manner.restlessness, Move: 1 / person.manner.tempo}


def _timed(
    person: SimulatedPerson, random: np.random.Generator, steps: Sequence[Step]
) -> list[Step]:
    """The steps with the durations they have this time for this person."""
    pace = _pace(person)
    variation = np.exp(JITTER * random.normal(size=len(steps)))
    return [
        replace(step, seconds=step.seconds * float(factor) * pace[type(step)])
        for step, factor in zip(steps, variation, strict=True)
    ]


def _least(steps: Sequence[Step]) -> float:
    """Seconds that the steps take with the shortest pauses."""
    return sum(s.seconds * (SHORTEST_PAUSE if isinstance(s, Pause) else 1.0) for s in steps)


def _fill(steps: Sequence[Step], duration: float) -> list[float]:
    """Pauses stretched to fill the duration; where moves alone exceed it, all is hurried."""
    pauses = sum(step.seconds for step in steps if isinstance(step, Pause))
    moves = sum(step.seconds for step in steps) - pauses
    stretch = max((duration - moves) / pauses, SHORTEST_PAUSE)
    hurry = duration / (moves + stretch * pauses)
    return [s.seconds * hurry * (stretch if isinstance(s, Pause) else 1.0) for s in steps]


def minimum_jerk(share: ArrayLike) -> Array:
    """Progress from 0 to 1 of a movement with rest at both ends, by the share of its time."""
    s = np.clip(np.asarray(share, float), 0.0, 1.0)
    return np.asarray(s**3 * (10.0 - 15.0 * s + 6.0 * s**2))


def track(times: Array, keys: Sequence[tuple[float, ArrayLike]]) -> Array:
    """Values (T, ...) through keys (time, value) in order of time, at rest at every key."""
    moments = [time for time, _ in keys]
    values = np.array([value for _, value in keys], float)
    result = np.repeat(values[:1], len(times), axis=0)
    for (start, end), change in zip(pairwise(moments), np.diff(values, axis=0), strict=True):
        result += np.multiply.outer(minimum_jerk((times - start) / (end - start)), change)
    return np.asarray(result)


def flow(times: Array, knots: Sequence[tuple[float, ArrayLike]]) -> Array:
    """Values (T, K) through knots (time, values (K,)) in order of time, without a halt at each.

    Every value rests only where it turns back or stays, and does not overshoot (Fritsch & Butland,
    1984); before the first knot and after the last it is as there.
    """
    at = np.array([time for time, _ in knots])
    values = np.array([value for _, value in knots], float)
    return np.asarray(PchipInterpolator(at, values)(np.clip(times, at[0], at[-1])))


@dataclass(frozen=True)
class Key:
    """A pose to be in at a time; its transform is a series (T, ...), for what it hangs on moves.

    bow is how far (metres, in the world) the way to this key swings out at its middle. by is a
    pose the way bends towards without stopping there: a quadratic Bezier curve's middle point.
    """

    time: float
    pose: Transform
    bow: tuple[float, float, float] = (0.0, 0.0, 0.0)
    by: Transform | None = None


def move_through(times: Array, keys: Sequence[Key]) -> Transform:
    """The poses (T, ...) through the keys, in order of time, at rest relative to each of them."""
    here = keys[0].pose
    translation, rotation = here.translation.copy(), here.rotation.copy()
    for first, second in pairwise(keys):
        inside = times >= first.time
        if not np.any(inside):
            break
        span = max(second.time - first.time, 1e-9)
        share = minimum_jerk((times[inside] - first.time) / span)
        passed = _pass(first.pose[inside], second, inside, share)
        swing = np.outer(16.0 * (share * (1.0 - share)) ** 2, second.bow)
        translation[inside] = passed.translation + swing
        rotation[inside] = passed.rotation
    return Transform(translation, rotation)


def _pass(here: Transform, key: Key, inside: Flags, share: Array) -> Transform:
    there = key.pose[inside]
    if key.by is None:
        return interpolate(here, there, share)
    between = key.by[inside]
    return interpolate(interpolate(here, between, share), interpolate(between, there, share), share)


def drift(times: Array, random: np.random.Generator, deviation: float, period: float) -> Array:
    """A slow wander (T,) about zero: sinusoids of random phase at and above the period, seconds."""
    periods = period * np.exp(random.uniform(-0.7, 0.7, 5))
    phases = random.uniform(0.0, 2.0 * np.pi, 5)
    waves = np.sin(2.0 * np.pi * times[:, None] / periods + phases)
    return np.asarray(deviation * np.sqrt(2.0 / 5.0) * waves.sum(axis=1))
