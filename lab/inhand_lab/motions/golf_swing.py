"""A golf swing as body, arms and club turn in it, put together from published figures.

Two levers, the arms and the club, turn in planes that lean towards the player [1]: the wrists cock
in the backswing until club and left arm are square, keep their angle in the first half of the
downswing and let go before impact, where left arm and club are nearly in line. The backswing takes
three times as long as the downswing: 24 frames to 8 at 30 Hz [2]. Shoulders turn by 90 degrees or
a little more [3], 48 degrees further than the hips; these turn back first, which widens the
difference by an eighth or so [4]. At impact the hips are about 32 degrees open and the shoulders
about 26 [5].

1. Cochran & Stobbs, *Search for the Perfect Swing*, 1968.
2. Novosel & Garrity, *Tour Tempo*, 2004.
3. Burden, Grimshaw & Wallace, *Hip and shoulder rotations during the golf swing of sub-10 handicap
   players*, Journal of Sports Sciences 16, 1998.
4. Cheetham et al., *The importance of stretching the "X-Factor" in the downswing of golf*, in
   Thomas (ed.), *Optimising Performance in Golf*, 2001.
5. McTeigue et al., *Spine and hip motion analysis during the golf swing*, in Cochran & Farrally
   (eds.), *Science and Golf II*, 1994.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.motions.script import Script
from inhand_lab.motions.timeline import Stage

DOWNSWING = (-0.267, 0.14)
DOWNSWING_RATE = (0.95, 1.4)
"""How much slower than in MOMENTS, which are good players', the downswing is at least and at
most."""

MOMENTS = np.array(
    [
        # time, pelvis, chest, arms, lag, reach, inside, lean, slide, heel, gaze
        (-1.067, 0, 4, -4, 12, 0.90, 0.25, 40, 0.00, 0, 0.0),  # address
        (-0.88, -8, -16, 20, 25, 0.88, 0.24, 39, 0.00, 0, 0.0),
        (-0.69, -20, -45, 55, 50, 0.84, 0.20, 38, 0.00, 0, 0.0),
        (-0.50, -34, -74, 100, 88, 0.78, 0.11, 37, 0.00, 0, 0.0),  # arms level
        (-0.267, -42, -90, 148, 108, 0.70, 0.03, 36, 0.00, 0, 0.0),  # top
        (-0.18, -27, -80, 135, 110, 0.72, 0.00, 36, -0.01, 0, 0.0),
        (-0.105, -4, -52, 90, 108, 0.80, -0.10, 34, -0.02, 3, 0.0),  # arms level
        (-0.05, 13, -18, 37, 71, 0.88, -0.10, 32, -0.035, 6, 0.0),  # club level
        (0.0, 32, 26, -9, 18, 0.94, 0.00, 30, -0.04, 10, 0.0),  # impact
        (0.035, 42, 46, -34, -14, 0.95, 0.04, 28, -0.045, 13, 0.0),
        (0.07, 51, 62, -55, -40, 0.93, 0.11, 25, -0.05, 16, 0.1),  # club level
        (0.14, 64, 84, -92, -72, 0.85, 0.14, 21, -0.06, 24, 0.4),  # arms level
        (0.25, 78, 105, -132, -94, 0.74, 0.15, 17, -0.075, 37, 0.8),
        (0.38, 85, 116, -158, -108, 0.63, 0.10, 14, -0.085, 46, 1.0),
        (0.52, 88, 120, -170, -116, 0.56, 0.06, 12, -0.09, 50, 1.0),  # finish
    ]
)
"""Seconds from impact; turns of pelvis and chest to the left, degrees; angle of the arms from
hanging, to the right, and of the club from the arms, degrees; distance of the hands from the
shoulders and how far inside the arms' plane they are, in lengths of the arm; lean of the spine,
degrees; hips to the right, in statures; right heel off the floor, degrees; the eyes from the ball
(0) to where it flies (1).

Times and turns are those of the sources. The angle of the club is that from the middle of the
shoulders, 15 to 20 degrees more than from the left arm. The reach is what a straight left arm
allows up to impact, and a straight right arm after it, until both fold. For the lean, the slide,
the heel and the eyes there is no source: they are drawn."""

RETURNING = np.array((38, 62, -64, -60, 0.86, -0.08, 25, -0.05, 15, 0.4))
"""On the way back from the finish to the address, as in MOMENTS."""
TAKING = np.array((2, 5, 0, 0, 0.80, 0.20, 52, 0.02, 0, 0.0))
"""While the club is fetched and brought back."""
UPRIGHT = np.array((0, 0, 0, 0, 0.80, 0.20, 0, 0.00, 0, 0.0))
FREE_WRIST = 35.0
"""People differ in how far they cock their wrists beyond this, degrees."""


@dataclass(frozen=True)
class Swing:
    """The swing over T frames, each (T,), as in MOMENTS, angles in radians; club from hanging."""

    pelvis: Array
    chest: Array
    arms: Array
    club: Array
    reach: Array
    inside: Array
    lean: Array
    slide: Array
    heel: Array
    gaze: Array


def plan_swings(script: Script) -> Swing:
    """The stages "reach", "take", "waggle", "swing", "recover", "return" and "withdraw"."""
    wrist = 1.0 + 0.2 * script.person.manner.grip_slide
    knots = [(0.0, UPRIGHT)]
    address = MOMENTS[0, 1:]
    for stage in script.stages:
        if stage.name in ("reach", "return"):
            knots.append((stage.end, TAKING))
        if stage.name == "take":
            knots += [(stage.start, TAKING), (stage.end, address)]
        if stage.name == "waggle":
            knots += _waggle(stage, address, script.random)
        if stage.name == "swing":
            knots += _swing(script, stage, wrist)
        if stage.name == "recover":
            finish = knots[-1][1]
            knots += [(stage.start, finish), (stage.at(0.5), RETURNING), (stage.end, address)]
        if stage.name == "withdraw":
            knots += [(stage.start, TAKING), (stage.end, UPRIGHT)]
    values = script.flow(_apart(knots))
    values[:, [0, 1, 2, 3, 6, 8]] = np.radians(values[:, [0, 1, 2, 3, 6, 8]])
    values[:, 3] += values[:, 2]
    return Swing(*values.T)


def _apart(knots: list[tuple[float, Array]]) -> list[tuple[float, Array]]:
    """The knots without those that repeat a time."""
    return [
        knot for number, knot in enumerate(knots) if number == 0 or knot[0] > knots[number - 1][0]
    ]


def _waggle(stage: Stage, address: Array, random: np.random.Generator) -> list[tuple[float, Array]]:
    """The club drawn back from the ball by the wrists once or twice, and set behind it again."""
    swings = int(random.integers(1, 3))
    knots = [(stage.start, address)]
    for at in np.arange(1, 2 * swings) / (2 * swings):
        lifted = address.copy()
        if round(at * 2 * swings) % 2 == 1:
            lifted[[2, 3]] += (random.uniform(0.0, 5.0), random.uniform(10.0, 30.0))
        knots.append((stage.at(at), lifted))
    return [*knots, (stage.end, address)]


def _swing(script: Script, stage: Stage, wrist: float) -> list[tuple[float, Array]]:
    """One swing; its size, its wrist and its backswing are the person's and vary a little."""
    random = script.random
    size = np.clip(script.person.manner.amplitude * (1.0 + 0.03 * random.normal()), 0.75, 1.05)
    cock = wrist + 0.06 * random.normal()
    knots = []
    for time, (_, *figures) in zip(_moments(stage, random), MOMENTS, strict=True):
        values = np.array(figures)
        values[:3] *= size
        values[3] += (cock - 1.0) * np.sign(values[3]) * max(abs(values[3]) - FREE_WRIST, 0.0)
        knots.append((time, values))
    return knots


def _moments(stage: Stage, random: np.random.Generator) -> list[float]:
    """The times of MOMENTS in this swing: people's downswings differ less than the rest of it."""
    spans = np.diff(MOMENTS[:, 0])
    fast = (MOMENTS[:-1, 0] >= DOWNSWING[0]) & (MOMENTS[:-1, 0] < DOWNSWING[1])
    whole = stage.seconds
    rate = np.clip(whole / spans.sum() + 0.1 + 0.03 * random.normal(), *DOWNSWING_RATE)
    slow_rate = (whole - rate * spans[fast].sum()) / spans[~fast].sum()
    return list(stage.start + np.cumsum([0.0, *(spans * np.where(fast, rate, slow_rate))]))
