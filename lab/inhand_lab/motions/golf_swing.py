"""A golf swing as body, arms and club turn in it.

Two levers, the arms and the club, turn in planes that lean towards the player (Cochran & Stobbs,
*Search for the Perfect Swing*, 1968): the wrists cock in the backswing, keep their angle in the
first half of the downswing and let go before impact. The backswing takes three times as long as
the downswing (Novosel & Garrity, *Tour Tempo*, 2004), the hips lead the shoulders.
The figures follow one good player's five measured swings, rounded, and moved where another body
would go through itself.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from inhand_lab.motions.timeline import Stage, flow
from inhand_lab.person import Person
from inhand_lab.transforms import Floats

DOWNSWING = (-0.26, 0.12)
DOWNSWING_RATE = (0.95, 1.4)
"""How much slower than in MOMENTS, which are a good player's, the downswing is at least and at
most."""

MOMENTS = np.array(
    [
        # time, pelvis, chest, arms, lag, reach, inside, lean, slide, heel, gaze
        (-1.06, 3, -5, -8, 17, 0.94, 0.24, 40, 0.00, 0, 0.0),
        (-0.82, -8, -25, 10, 32, 0.96, 0.24, 38, 0.00, 0, 0.0),
        (-0.60, -24, -70, 82, 70, 0.91, 0.20, 35, 0.00, 0, 0.0),
        (-0.43, -35, -93, 135, 105, 0.80, 0.08, 35, 0.00, 0, 0.0),
        (-0.26, -36, -98, 155, 112, 0.66, 0.02, 36, -0.02, 0, 0.0),
        (-0.16, -20, -77, 135, 112, 0.68, 0.06, 36, -0.03, 0, 0.0),
        (-0.08, 4, -42, 78, 104, 0.81, 0.01, 34, -0.05, 4, 0.0),
        (-0.04, 15, -25, 33, 79, 0.91, 0.02, 32, -0.055, 7, 0.0),
        (0.00, 23, -8, -4, 38, 0.95, 0.08, 30, -0.06, 10, 0.0),
        (0.03, 27, 4, -23, -7, 0.97, 0.06, 26, -0.06, 12, 0.0),
        (0.06, 31, 24, -41, -36, 0.95, 0.09, 24, -0.065, 14, 0.05),
        (0.12, 43, 78, -76, -64, 0.92, 0.15, 21, -0.07, 20, 0.3),
        (0.22, 65, 110, -125, -93, 0.78, 0.17, 18, -0.085, 35, 0.7),
        (0.35, 80, 118, -160, -110, 0.64, 0.12, 15, -0.095, 48, 1.0),
        (0.50, 85, 124, -178, -124, 0.54, 0.05, 13, -0.10, 52, 1.0),
    ]
)
"""Seconds from impact; turns of pelvis and chest to the left, degrees; angle of the arms from
hanging, to the right, and of the club from the arms, degrees; distance of the hands from the
shoulders and how far inside the arms' plane they are, in lengths of the arm; lean of the spine,
degrees; hips to the right, in statures; right heel off the floor, degrees; the eyes from the ball
(0) to where it flies (1)."""

RETURNING = np.array((30, 45, -70, -60, 0.84, 0.08, 25, -0.05, 15, 0.4))
"""On the way back from the finish to the address, as in MOMENTS."""
TAKING = np.array((2, 5, 0, 0, 0.80, 0.20, 52, 0.02, 0, 0.0))
"""While the club is fetched and brought back."""
UPRIGHT = np.array((0, 0, 0, 0, 0.80, 0.20, 0, 0.00, 0, 0.0))
FREE_WRIST = 35.0
"""People differ in how far they cock their wrists beyond this, degrees."""


@dataclass(frozen=True)
class Swing:
    """The swing over T frames, each (T,), as in MOMENTS, angles in radians; club from hanging."""

    pelvis: Floats
    chest: Floats
    arms: Floats
    club: Floats
    reach: Floats
    inside: Floats
    lean: Floats
    slide: Floats
    heel: Floats
    gaze: Floats


def plan_swings(
    person: Person, times: Floats, random: np.random.Generator, stages: list[Stage]
) -> Swing:
    """The stages "reach", "take", "waggle", "swing", "recover", "return" and "withdraw"."""
    wrist = 1.0 + 0.2 * person.manner.grip_slide
    knots = [(0.0, UPRIGHT)]
    address = MOMENTS[0, 1:]
    for stage in stages:
        span = stage.end - stage.start
        if stage.name in ("reach", "return"):
            knots.append((stage.end, TAKING))
        if stage.name == "take":
            knots += [(stage.start, TAKING), (stage.end, address)]
        if stage.name == "waggle":
            knots += _waggle(stage, address, random)
        if stage.name == "swing":
            knots += _swing(person, stage, wrist, random)
        if stage.name == "recover":
            knots += [
                (stage.start, knots[-1][1]),
                (stage.start + 0.5 * span, RETURNING),
                (stage.end, address),
            ]
        if stage.name == "withdraw":
            knots += [(stage.start, TAKING), (stage.end, UPRIGHT)]
    values = flow(times, _apart(knots))
    values[:, [0, 1, 2, 3, 6, 8]] = np.radians(values[:, [0, 1, 2, 3, 6, 8]])
    values[:, 3] += values[:, 2]
    return Swing(*values.T)


def _apart(knots: list[tuple[float, Floats]]) -> list[tuple[float, Floats]]:
    """The knots without those that repeat a time."""
    return [
        knot for number, knot in enumerate(knots) if number == 0 or knot[0] > knots[number - 1][0]
    ]


def _waggle(
    stage: Stage, address: Floats, random: np.random.Generator
) -> list[tuple[float, Floats]]:
    """The club drawn back from the ball by the wrists once or twice, and set behind it again."""
    swings = int(random.integers(1, 3))
    knots = [(stage.start, address)]
    for at in np.arange(1, 2 * swings) / (2 * swings):
        lifted = address.copy()
        if round(at * 2 * swings) % 2 == 1:
            lifted[[2, 3]] += (random.uniform(0.0, 5.0), random.uniform(10.0, 30.0))
        knots.append((stage.start + at * (stage.end - stage.start), lifted))
    return [*knots, (stage.end, address)]


def _swing(
    person: Person, stage: Stage, wrist: float, random: np.random.Generator
) -> list[tuple[float, Floats]]:
    """One swing; its size, its wrist and its backswing are the person's and vary a little."""
    size = np.clip(person.manner.amplitude * (1.0 + 0.03 * random.normal()), 0.75, 1.05)
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
    whole = stage.end - stage.start
    rate = np.clip(whole / spans.sum() + 0.1 + 0.03 * random.normal(), *DOWNSWING_RATE)
    slow_rate = (whole - rate * spans[fast].sum()) / spans[~fast].sum()
    return list(stage.start + np.cumsum([0.0, *(spans * np.where(fast, rate, slow_rate))]))
