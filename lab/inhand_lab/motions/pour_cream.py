"""pourCream: take a small jug from a table, pour from it into a cup, put it back."""

from __future__ import annotations

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import Transform, rotation_about, rotation_from_axes
from inhand_lab.motions.furniture import Cuboid, Furniture, side_table
from inhand_lab.motions.grips import hold_bar
from inhand_lab.motions.performance import Performance, Stance, hanging_hands
from inhand_lab.motions.reaching import (
    PUT_BACK,
    TAKE,
    attention,
    carried_by,
    helping_hand,
    reaching_hand,
)
from inhand_lab.motions.script import Script, To, write_script
from inhand_lab.motions.timeline import Move, Pause, Plan
from inhand_lab.objects.jug import JUG_BELLY, JUG_HANDLE_REACH, JUG_HEIGHT, SPOUT
from inhand_lab.people.person import SimulatedPerson

PLAN = Plan(
    opening=(*TAKE, Move("lift", 1.0)),
    use=(Pause("hold", 0.4), Move("tip", 0.8), Pause("pour", 1.0), Move("right", 0.7)),
    closing=(Pause("hold", 0.4), *PUT_BACK),
    on_stool=True,
)

FIST_TURN = np.radians(-60.0)
"""Turn of the fist about the handle in the jug's frame: the vessel is ahead and to the left."""

FINGERS_AT_TABLE, FINGERS_POURING = 0.10, 0.50
"""Where the fingers point, as turns to the left from straight ahead, radians."""

HELD_TILT, FIRST_TILT, MORE_TILT, DEEPEST_TILT = 0.06, 0.80, 0.12, 1.05
"""Tilt of the jug, radians: between pourings, at the first one, what each next one adds as it
empties, and the limit."""

POURING_HEIGHT, HOLDING_HEIGHT, SHORT_OF_CUP = 0.045, 0.090, 0.035
"""The spout above the cup's rim while pouring and between, and short of its middle between."""

CUP_WIDTH, CUP_HEIGHT = 0.084, 0.066
CUP_COLOUR, COFFEE = (224, 222, 216), (72, 44, 26)


def perform(person: SimulatedPerson, times: Array, random: np.random.Generator) -> Performance:
    """Pouring at these times, in seconds from the start."""
    script = write_script(person, times, random, PLAN)
    posture, trunk = script.stand(_stance(script))
    furniture, spot, cup = _table(script)
    carried = _carry(script, spot, cup)
    held = carried @ _grip(script)
    right_rest, left_rest = hanging_hands(person, trunk, random)
    right_hand = reaching_hand(script, right_rest, held, bow=(0.06, -0.07, 0.14))
    left_hand = _steady_cup(script, left_rest, cup)
    return Performance(
        posture, right_hand, left_hand, carried, carried_by(script), furniture, script.stages
    )


def _stance(script: Script) -> Stance:
    """A look at the jug, and down at the cup while pouring."""
    looked = attention(script)
    poured = script.level(0.0, {"lift": 1.0, "return": 0.0})
    trunk = np.outer(looked, [0.10, 0.02, -0.08]) + np.outer(poured, [0.12, 0.0, 0.05])
    head = np.outer(looked, [-0.30, 0.0, -0.20]) + np.outer(poured, [-0.42, 0.0, 0.08])
    return script.upright_stance(trunk, head)


def _table(script: Script) -> tuple[Furniture, Array, Array]:
    """A table ahead, the jug's place on it (3,) and the middle of the cup's rim (3,)."""
    top = script.table_top(0.53)
    spot = np.array([*script.place(0.20, 0.36), top + JUG_HEIGHT / 2.0])
    x, y = script.place(-0.03, 0.41)
    table = side_table(0.08, 0.24 * script.size + 0.20, top)
    return (*table, *_cup(x, y, top), *script.seat), spot, np.array([x, y, top + CUP_HEIGHT])


def _cup(x: float, y: float, top: float) -> Furniture:
    """A cup of coffee on a table, round as cuboids go."""
    middle, square, narrow = top + CUP_HEIGHT / 2.0, 0.74 * CUP_WIDTH, 0.44 * CUP_WIDTH
    walls = (
        Cuboid((x, y, middle), (CUP_WIDTH, narrow, CUP_HEIGHT), CUP_COLOUR),
        Cuboid((x, y, middle), (narrow, CUP_WIDTH, CUP_HEIGHT), CUP_COLOUR),
        Cuboid((x, y, middle), (square, square, CUP_HEIGHT), CUP_COLOUR),
    )
    coffee = Cuboid((x, y, top + CUP_HEIGHT), (0.62 * CUP_WIDTH, 0.62 * CUP_WIDTH, 0.002), COFFEE)
    return (*walls, coffee)


def _carry(script: Script, spot: Array, cup: Array) -> Transform:
    """The jug's way, world_from_object (T): at the cup it tips about its spout."""
    manner = script.person.manner

    def heading(fingers_to_left: float) -> float:
        return fingers_to_left - FIST_TURN - manner.grip_turn + script.random.normal(0.0, 0.1)

    on_table = script.still(Transform(spot, rotation_about("z", heading(FINGERS_AT_TABLE))))
    tilt, lowered = _tip(script)
    turned = rotation_about("z", heading(FINGERS_POURING) + script.drift(0.05, 3.0))
    tipped = turned @ rotation_about("x", -tilt)
    spout = cup + script.drifts(0.005, 2.5)
    spout -= turned[:, :, 1] * (SHORT_OF_CUP * (1.0 - lowered))[:, None]
    spout[:, 2] += lowered * POURING_HEIGHT + (1.0 - lowered) * HOLDING_HEIGHT * manner.amplitude
    at_cup = Transform(spout - tipped @ SPOUT, tipped)
    goals = {
        "lift": To(at_cup, bow=(0.0, 0.0, 0.04)),
        "return": To(on_table, bow=(0.0, 0.0, 0.05)),
    }
    return script.way(on_table, goals)


def _tip(script: Script) -> tuple[Array, Array]:
    """The jug's tilt (T,), radians, and how far (T,), 0 to 1, it is lowered to the cup."""
    tilts = [(0.0, HELD_TILT)]
    for stage in script.every("tip", "right"):
        if stage.name == "tip":
            deepest = FIRST_TILT + MORE_TILT * stage.repetition + 0.08 * script.random.normal()
            deepest = min(deepest, DEEPEST_TILT)
            tilts += [(stage.start, HELD_TILT), (stage.end, 0.8 * deepest)]
        else:
            tilts += [(stage.start, deepest), (stage.end, HELD_TILT)]
    parts = {"tip": (0.0, 0.8), "right": (0.3, 1.0)}
    return script.track(tilts), script.level(0.0, {"tip": 1.0, "right": 0.0}, parts)


def _grip(script: Script) -> Transform:
    """A fist around the handle, the vessel ahead of it and to its left, object_from_hand (T)."""
    handle = np.array([0.0, -JUG_BELLY - JUG_HANDLE_REACH, 0.004])
    square = rotation_about("z", FIST_TURN + script.person.manner.grip_turn)
    return hold_bar(script, handle, square)


def _steady_cup(script: Script, rest: Transform, cup: Array) -> Transform:
    """The left hand, world_from_hand (T): some steady the cup with it, others let it hang."""
    if script.random.random() < 0.5:
        return rest
    palm = cup + np.array([-0.095, -0.062, 0.015])
    rotation = rotation_from_axes([0.30, 0.92, -0.10], [0.10, 0.10, 1.0])
    return helping_hand(script, rest, Transform(palm, rotation))
