"""The script of a performance: who performs, when, in which stages, and what fills the stages."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array
from numpy.typing import ArrayLike

from inhand_lab.geometry.transforms import Transform
from inhand_lab.motions.furniture import Furniture
from inhand_lab.motions.interruptions import (
    draw_interruptions,
    given_up_times,
    interrupted_times,
    place_interruptions,
)
from inhand_lab.motions.parameters import DEFAULT_VARIETY
from inhand_lab.motions.performance import STANCE_HALF_WIDTH, Stance, feet_apart, sit, stand, stool
from inhand_lab.motions.timeline import (
    Key,
    Plan,
    Stage,
    drift,
    flow,
    move_through,
    schedule,
    spare_time,
    track,
)
from inhand_lab.people.kinematics import Posture, Trunk, place_trunk
from inhand_lab.people.person import SimulatedPerson

USUAL_HEIGHT = 1.75
"""Stature, in metres, for which the motions give their distances."""

WHOLE = (0.0, 1.0)


@dataclass(frozen=True)
class To:
    """Where a stage brings something: a pose (T), or what makes one when the stage's turn comes.

    What is made may be None, for staying. bow and by shape the way, as in Key; part is when it is
    gone, as shares of the stage.
    """

    goal: Transform | Callable[[Stage], Transform | None]
    bow: tuple[float, float, float] = (0.0, 0.0, 0.0)
    by: Transform | Callable[[Stage], Transform] | None = None
    part: tuple[float, float] = WHOLE

    def keys(self, stage: Stage, here: Transform) -> list[Key]:
        """The poses, from where it is, at the two ends of its part of that stage."""
        goal = self.goal(stage) if callable(self.goal) else self.goal
        by = self.by(stage) if callable(self.by) else self.by
        if goal is None:
            return []
        start, end = (stage.at(share) for share in self.part)
        return [Key(start, here), Key(end, goal, self.bow, by)]


@dataclass(frozen=True)
class Script:
    """What every part of a performance is made from; times (T,) are seconds from the start.

    They stand still or go back where somebody stops; ``clock`` (T,) does not: sway goes on.
    The parts draw what is by chance from random, so their order belongs to the performance; what
    varied people draw beside it comes from ``apart``, so that the rest is the same without.
    """

    person: SimulatedPerson
    times: Array
    random: np.random.Generator
    stages: list[Stage]
    clock: Array
    apart: np.random.Generator
    seated: bool = False

    @property
    def size(self) -> float:
        """Stature of the person as a share of the usual one."""
        return self.person.height / USUAL_HEIGHT

    def stage(self, name: str) -> Stage:
        """The first stage of that name."""
        return next(stage for stage in self.stages if stage.name == name)

    def every(self, *names: str) -> list[Stage]:
        """The stages of those names, in order of time."""
        return [stage for stage in self.stages if stage.name in names]

    def way(self, start: Transform, goals: Mapping[str, To | tuple[To, ...]]) -> Transform:
        """The poses (T) of something that stages, by name, bring from a pose (T) to others."""
        keys = [Key(0.0, start)]
        for stage in self.every(*goals):
            goal = goals[stage.name]
            for part in goal if isinstance(goal, tuple) else (goal,):
                keys += part.keys(stage, keys[-1].pose)
        return move_through(self.times, keys)

    def level(
        self,
        start: float,
        goals: Mapping[str, float | Callable[[Stage], float]],
        parts: Mapping[str, tuple[float, float]] | None = None,
    ) -> Array:
        """Values (T,) that stages, by name, bring from a start to others, at rest in between.

        parts is when a value changes, as shares of a stage, where it is not all the time.
        """
        keys = [(0.0, start)]
        for stage in self.every(*goals):
            goal = goals[stage.name]
            first, last = (parts or {}).get(stage.name, WHOLE)
            if stage.at(first) > keys[-1][0]:
                keys.append((stage.at(first), keys[-1][1]))
            keys.append((stage.at(last), goal(stage) if callable(goal) else goal))
        return self.track(keys)

    def around(self, stage: Stage, before: float, after: float) -> Array:
        """Share (T,) of 1 during a stage: it rises for some seconds before, and falls after it."""
        bounds = (stage.start - before, stage.start, stage.end, stage.end + after)
        return self.track(list(zip(bounds, (0.0, 1.0, 1.0, 0.0), strict=True)))

    def track(self, keys: Sequence[tuple[float, ArrayLike]]) -> Array:
        """Values (T, ...) through keys (time, value), at rest at every key."""
        return track(self.times, keys)

    def flow(self, knots: Sequence[tuple[float, ArrayLike]]) -> Array:
        """Values (T, K) through knots (time, values (K,)), without a halt at each."""
        return flow(self.times, knots)

    def drift(self, deviation: float, period: float) -> Array:
        """A slow wander (T,) about zero; the period is in seconds."""
        return drift(self.clock, self.random, deviation, period)

    def drifts(self, deviation: float, period: float, count: int = 3) -> Array:
        """Slow wanders (T, count), independent of each other."""
        return np.stack([self.drift(deviation, period) for _ in range(count)], axis=1)

    def still(self, pose: Transform) -> Transform:
        """A pose that lasts all the time (T)."""
        return pose.repeated(len(self.times))

    def place(self, across: float, ahead: float, spread: float = 0.015) -> Array:
        """A place (2,) to the right and ahead, metres of the usual stature; it varies by spread."""
        usual = np.array([across, ahead]) * self.size
        factor = DEFAULT_VARIETY.places if self.person.varied else 1.0
        return np.asarray(usual + self.random.normal(0.0, factor * spread, 2))

    def table_top(self, share: float, spread: float = 0.015) -> float:
        """Height of a table, metres, by a share of the stature; it varies by spread."""
        factor = DEFAULT_VARIETY.heights if self.person.varied else 1.0
        standing = share * self.person.height + float(self.random.normal(0.0, factor * spread))
        return standing - self.seated * DEFAULT_VARIETY.seat_drop * self.person.height

    def upright_stance(
        self,
        trunk_angles: Array,
        head_angles: Array,
        shift: Array | None = None,
        half_width: float = STANCE_HALF_WIDTH,
    ) -> Stance:
        """Feet side by side that stay where they are, and what the rest of the body does."""
        count = len(self.times)
        still = np.zeros((count, 3)) if shift is None else shift
        feet = feet_apart(self.person, count, half_width)
        stance = Stance(*feet, np.zeros(count), still, trunk_angles, head_angles)
        return sit(self.person, stance) if self.seated else stance

    @property
    def seat(self) -> Furniture:
        """The stool under who sits."""
        return stool(self.person) if self.seated else ()

    def stand(self, stance: Stance) -> tuple[Posture, Trunk]:
        """The body on its feet, and the frames that hands are placed by."""
        posture = stand(self.person, self.clock, self.random, stance)
        return posture, place_trunk(self.person, posture)


def write_script(
    person: SimulatedPerson, times: Array, random: np.random.Generator, plan: Plan
) -> Script:
    """The plan's stages at these times, as the person's tempo and chance have them.

    Varied people may sit, stop in between, break off a movement if that leaves time for all of the
    plan, or give up.
    """
    duration = float(times[-1])
    (apart,) = random.spawn(1)
    if not person.varied:
        stages = schedule(person, random, duration, plan)
        return Script(person, times, random, stages, times, apart)
    variety = DEFAULT_VARIETY
    seated = apart.random() < variety.seated and plan.on_stool
    interruptions = draw_interruptions(apart, spare_time(person, duration, plan))
    cost = sum(interruption.cost() for interruption in interruptions)
    stages = schedule(person, random, duration - cost, plan)
    placed = place_interruptions(apart, interruptions, stages)
    gives_up = apart.random() < variety.unfinished
    bent = given_up_times(times, apart, stages) if gives_up else interrupted_times(times, placed)
    return Script(person, bent, random, stages, times, apart, seated)
