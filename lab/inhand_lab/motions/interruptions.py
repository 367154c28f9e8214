"""Interruptions: somebody stops in a movement for a moment, or breaks it off and begins again.

They bend the time of a script, so that body, hands and things stop and go back together: whatever
holds in the uninterrupted performance holds in the interrupted one too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array
from scipy.interpolate import CubicHermiteSpline

from inhand_lab.motions.parameters import DEFAULT_VARIETY, PerformanceVariety
from inhand_lab.motions.timeline import Stage

BACKWARDS = 1.5
"""Time over which a second of movement is undone, seconds: it is fastest, at its middle, at the
pace of the movement itself."""


@dataclass(frozen=True)
class Interruption:
    """A stop: after how much of a stage, for how long, and whether the stage is then undone.

    ``after``, ``stop`` and ``slowing``, the time that stopping and going on each take, are seconds.
    """

    after: float
    stop: float
    undone: bool
    slowing: float

    def cost(self) -> float:
        """Seconds by which a performance lasts longer for it."""
        return self.slowing + self.stop + self.undone * (BACKWARDS + 1.0) * self.after


def draw_interruptions(
    random: np.random.Generator, spare: float, variety: PerformanceVariety = DEFAULT_VARIETY
) -> list[Interruption]:
    """Interruptions of one performance that cost no more than ``spare`` seconds together."""
    drawn = []
    for _ in range(int(random.poisson(variety.interruptions))):
        interruption = Interruption(
            after=float(random.uniform(*variety.interrupted_after_s)),
            stop=float(random.uniform(*variety.stop_s)),
            undone=bool(random.random() < variety.undone),
            slowing=variety.slowing_s,
        )
        if interruption.cost() <= spare:
            drawn.append(interruption)
            spare -= interruption.cost()
    return drawn


def place_interruptions(
    random: np.random.Generator, interruptions: Sequence[Interruption], stages: Sequence[Stage]
) -> list[tuple[float, Interruption]]:
    """The starts, in seconds, of stages that are interrupted, in order of time.

    Each is in a stage of its own that is longer than what is done of it; others are left out.
    """
    free = [stage for stage in stages if stage.breakable]
    placed = []
    for interruption in interruptions:
        fitting = [s for s in free if s.seconds > interruption.after + interruption.slowing]
        if fitting:
            stage = fitting[int(random.integers(len(fitting)))]
            placed.append((stage.start, interruption))
            free.remove(stage)
    return sorted(placed, key=lambda pair: pair[0])


def interrupted_times(times: Array, placed: Sequence[tuple[float, Interruption]]) -> Array:
    """Times of the script (T,), in seconds, at ``times`` (T,) of a performance with interruptions.

    They run as the clock does but where somebody stops, and backwards where a stage is undone.
    """
    clock, script = -1.0, -1.0
    knots = [(clock, script, 1.0)]
    for start, interruption in placed:
        slowing, turn = interruption.slowing, start + interruption.after
        begins = turn - 0.5 * slowing
        clock += begins - script
        stopped = clock + slowing
        goes_on = stopped + interruption.stop
        knots += [(clock, begins, 1.0), (stopped, turn, 0.0), (goes_on, turn, 0.0)]
        if interruption.undone:
            goes_on += BACKWARDS * interruption.after
            turn = start
            knots.append((goes_on, turn, 0.0))
        clock, script = goes_on + slowing, turn + 0.5 * slowing
        knots.append((clock, script, 1.0))
    rest = max(float(times[-1]) - clock, 0.0) + 1.0
    knots.append((clock + rest, script + rest, 1.0))
    at, values, rates = np.array(knots).T
    return np.asarray(CubicHermiteSpline(at, values, rates)(times))


def given_up_times(
    times: Array,
    random: np.random.Generator,
    stages: Sequence[Stage],
    variety: PerformanceVariety = DEFAULT_VARIETY,
) -> Array:
    """Times of the script (T,), in seconds, at ``times`` (T,) for somebody who gives up.

    After a while everything is undone, for good. What is swift, a swing say, is not begun: nobody
    undoes it.
    """
    swift = (stage.start for stage in stages if stage.swift)
    latest = next(swift, stages[-1].end) - 0.5 * variety.slowing_s
    tired = float(random.uniform(*variety.given_up_after)) * stages[-1].end
    giving_up = Interruption(
        after=min(tired, latest),
        stop=float(random.uniform(*variety.stop_s)),
        undone=True,
        slowing=variety.slowing_s,
    )
    undone = giving_up.cost() - 0.5 * giving_up.slowing
    return np.where(times < undone, interrupted_times(times, [(0.0, giving_up)]), 0.0)
