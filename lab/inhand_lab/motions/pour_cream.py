"""pourCream: take a small jug from a table, pour from it into a cup, put it back."""

from __future__ import annotations

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import Transform, rotation_about, rotation_from_axes
from inhand_lab.motions.furniture import Cuboid, Furniture, side_table
from inhand_lab.motions.grips import hold_bar
from inhand_lab.motions.performance import (
    Performance,
    Stance,
    feet_apart,
    hanging_hands,
    stand,
)
from inhand_lab.motions.reaching import (
    PUT_BACK,
    TAKE,
    attention,
    held_by_right_hand,
    helping_hand,
    named,
    reaching_hand,
)
from inhand_lab.motions.timeline import (
    Key,
    Move,
    Pause,
    Stage,
    drift,
    move_through,
    schedule,
    track,
)
from inhand_lab.objects.jug import JUG_BELLY, JUG_HANDLE_REACH, JUG_HEIGHT, SPOUT
from inhand_lab.people.kinematics import place_trunk
from inhand_lab.people.person import SimulatedPerson

OPENING = (*TAKE, Move("lift", 1.0))
USE = (
    Pause("hold", 0.4),
    Move("tip", 0.8),
    Pause("pour", 1.0),
    Move("right", 0.7),
)
CLOSING = (Pause("hold", 0.4), *PUT_BACK)

FIST_TURN = np.radians(-60.0)
"""Turn of the fist about the handle in the jug's frame: the vessel is ahead and to the left."""

FINGERS_AT_TABLE, FINGERS_POURING = 0.10, 0.50
"""Where the fingers point, as turns to the left from straight ahead, radians."""

FIRST_TILT, MORE_TILT, DEEPEST_TILT = 0.80, 0.12, 1.05
"""Tilt of the jug at the first pouring, what each next one adds as it empties, and the limit."""

POURING_HEIGHT, HOLDING_HEIGHT, SHORT_OF_CUP = 0.045, 0.090, 0.035
"""The spout above the cup's rim while pouring and between, and short of its middle between."""

CUP_WIDTH, CUP_HEIGHT = 0.084, 0.066
CUP_COLOUR, COFFEE = (224, 222, 216), (72, 44, 26)


def perform(person: SimulatedPerson, times: Array, random: np.random.Generator) -> Performance:
    """Pouring at these times, in seconds from the start."""
    stages = schedule(person, random, float(times[-1]), OPENING, USE, CLOSING)
    posture = stand(person, times, random, _stance(times, stages))
    trunk = place_trunk(person, posture)
    furniture, spot, cup = _table(person, random)
    carried = _carry(person, times, random, spot, cup, stages)
    handle = np.array([0.0, -JUG_BELLY - JUG_HANDLE_REACH, 0.004])
    square = rotation_about("z", FIST_TURN + person.manner.grip_turn)
    grip = hold_bar(person, times, random, handle, square)
    right_rest, left_rest = hanging_hands(person, trunk, random)
    return Performance(
        posture,
        reaching_hand(times, stages, right_rest, carried @ grip, bow=(0.06, -0.07, 0.14)),
        _steady_cup(times, random, left_rest, cup, stages),
        carried,
        held_by_right_hand(times, stages),
        furniture,
    )


def _stance(times: Array, stages: list[Stage]) -> Stance:
    """A look at the jug, and down at the cup while pouring."""
    count = len(times)
    looked = attention(times, stages)[:, None]
    lift, back = named(stages, "lift"), named(stages, "return")
    keys = [(lift.start, 0.0), (lift.end, 1.0), (back.start, 1.0), (back.end, 0.0)]
    poured = track(times, keys)[:, None]
    trunk = looked * np.array([0.10, 0.02, -0.08]) + poured * np.array([0.12, 0.0, 0.05])
    head = looked * np.array([-0.30, 0.0, -0.20]) + poured * np.array([-0.42, 0.0, 0.08])
    right_foot, left_foot = feet_apart(count)
    return Stance(right_foot, left_foot, np.zeros(count), np.zeros((count, 3)), trunk, head)


def _table(person: SimulatedPerson, random: np.random.Generator) -> tuple[Furniture, Array, Array]:
    """A table ahead, the jug's place on it (3,) and the middle of the cup's rim (3,)."""
    size = person.height / 1.75
    top = 0.53 * person.height + random.normal(0.0, 0.015)
    across, ahead = np.array([0.20, 0.36]) * size + random.normal(0.0, 0.015, 2)
    spot = np.array([across, ahead, top + JUG_HEIGHT / 2.0])
    across, ahead = np.array([-0.03, 0.41]) * size + random.normal(0.0, 0.015, 2)
    cup = np.array([across, ahead, top + CUP_HEIGHT])
    table = side_table(0.08, 0.24 * size + 0.20, top)
    return (*table, *_cup(across, ahead, top)), spot, cup


def _cup(x: float, y: float, top: float) -> Furniture:
    """A cup of coffee on a table, round as boxes go."""
    middle, square, narrow = top + CUP_HEIGHT / 2.0, 0.74 * CUP_WIDTH, 0.44 * CUP_WIDTH
    walls = (
        Cuboid((x, y, middle), (CUP_WIDTH, narrow, CUP_HEIGHT), CUP_COLOUR),
        Cuboid((x, y, middle), (narrow, CUP_WIDTH, CUP_HEIGHT), CUP_COLOUR),
        Cuboid((x, y, middle), (square, square, CUP_HEIGHT), CUP_COLOUR),
    )
    coffee = Cuboid((x, y, top + CUP_HEIGHT), (0.62 * CUP_WIDTH, 0.62 * CUP_WIDTH, 0.002), COFFEE)
    return (*walls, coffee)


def _carry(
    person: SimulatedPerson,
    times: Array,
    random: np.random.Generator,
    spot: Array,
    cup: Array,
    stages: list[Stage],
) -> Transform:
    """The jug's way, world_from_object (T): at the cup it tips about its spout."""

    def heading(fingers_to_left: float) -> float:
        return fingers_to_left - FIST_TURN - person.manner.grip_turn + random.normal(0.0, 0.1)

    on_table = rotation_about("z", heading(FINGERS_AT_TABLE))
    tilt, lowered = _tip(times, random, stages)
    turned = rotation_about("z", heading(FINGERS_POURING) + drift(times, random, 0.05, 3.0))
    tipped = turned @ rotation_about("x", -tilt)
    wander = np.stack([drift(times, random, 0.005, 2.5) for _ in range(3)], axis=1)
    height = lowered * POURING_HEIGHT + (1.0 - lowered) * HOLDING_HEIGHT * person.manner.amplitude
    short = SHORT_OF_CUP * (1.0 - lowered)
    spout = cup + wander - turned[:, :, 1] * short[:, None]
    spout[:, 2] += height
    at_cup = Transform(spout - tipped @ SPOUT, tipped)
    rest = Transform(spot, on_table).repeated(len(times))
    lift, back = named(stages, "lift"), named(stages, "return")
    return move_through(
        times,
        [
            Key(lift.start, rest),
            Key(lift.end, at_cup, bow=(0.0, 0.0, 0.04)),
            Key(back.start, at_cup),
            Key(back.end, rest, bow=(0.0, 0.0, 0.05)),
        ],
    )


def _tip(times: Array, random: np.random.Generator, stages: list[Stage]) -> tuple[Array, Array]:
    """The jug's tilt (T,), radians, and how far (T,), 0 to 1, it is lowered to the cup."""
    tilts, lowers = [(0.0, 0.06)], [(0.0, 0.0)]
    for stage in stages:
        if stage.name == "tip":
            deepest = FIRST_TILT + MORE_TILT * stage.repetition + 0.08 * random.normal()
            deepest = min(deepest, DEEPEST_TILT)
            tilts += [(stage.start, 0.06), (stage.end, 0.8 * deepest)]
            lowers += [(stage.start, 0.0), (stage.start + 0.8 * (stage.end - stage.start), 1.0)]
        if stage.name == "right":
            tilts += [(stage.start, deepest), (stage.end, 0.06)]
            lowers += [(stage.start + 0.3 * (stage.end - stage.start), 1.0), (stage.end, 0.0)]
    return track(times, tilts), track(times, lowers)


def _steady_cup(
    times: Array,
    random: np.random.Generator,
    rest: Transform,
    cup: Array,
    stages: list[Stage],
) -> Transform:
    """The left hand, world_from_hand (T): some steady the cup with it, others let it hang."""
    if random.random() < 0.5:
        return rest
    palm = cup + np.array([-0.095, -0.062, 0.015])
    rotation = rotation_from_axes([0.30, 0.92, -0.10], [0.10, 0.10, 1.0])
    return helping_hand(times, stages, rest, Transform(palm, rotation))
