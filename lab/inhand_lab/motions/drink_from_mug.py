"""drinkFromMug: take a mug from a side table, drink from it now and then, put it back."""

from __future__ import annotations

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import Transform, rotation_about
from inhand_lab.motions.furniture import Furniture, side_table
from inhand_lab.motions.grips import hold_bar
from inhand_lab.motions.idle_hand import idle_left_hand
from inhand_lab.motions.performance import (
    Performance,
    Stance,
    hanging_hands,
    heading_of,
    mouth,
    upright,
)
from inhand_lab.motions.reaching import PUT_BACK, TAKE, attention, carried_by
from inhand_lab.motions.script import Script, To, write_script
from inhand_lab.motions.timeline import Move, Pause, Plan, Stage
from inhand_lab.objects.mug import MUG_HANDLE_REACH, MUG_HEIGHT, MUG_RADIUS
from inhand_lab.people.kinematics import Trunk
from inhand_lab.people.person import SimulatedPerson

PLAN = Plan(
    opening=(*TAKE, Move("lift", 0.9)),
    use=(Pause("hold", 0.6), Move("raise", 0.9), Move("sip", 1.3), Move("lower", 0.9)),
    closing=(Pause("hold", 0.6), *PUT_BACK),
    on_stool=True,
)

FIST_TURN = np.radians(135.0)
"""Turn of the fist about the handle in the mug's frame: the cup is ahead and to the left."""

FINGERS_AT_TABLE, FINGERS_CARRIED, FINGERS_AT_MOUTH = 0.25, 0.80, 1.40
"""Where the fingers point, as turns to the left from straight ahead, radians."""


def perform(person: SimulatedPerson, times: Array, random: np.random.Generator) -> Performance:
    """Drinking at these times, in seconds from the start."""
    script = write_script(person, times, random, PLAN)
    posture, trunk = script.stand(_stance(script))
    table, spot = _table(script)
    grip = _grip(script)
    carried = _carry(script, trunk, spot)
    rest, left_rest = hanging_hands(person, trunk, random)
    reach = To(carried @ grip, bow=(0.06, -0.05, 0.10))
    right_hand = script.way(rest, {"reach": reach, "withdraw": To(rest, bow=(0.06, -0.05, 0.08))})
    left_hand = idle_left_hand(script, trunk, left_rest)
    return Performance(
        posture, right_hand, left_hand, carried, carried_by(script), table, script.stages
    )


def _stance(script: Script) -> Stance:
    """A look and a twist to the table, and the head back while drinking."""
    looked = attention(script)
    trunk, head = np.outer(looked, [0.10, 0.03, -0.15]), np.outer(looked, [-0.30, 0.0, -0.35])
    for sip in script.every("sip"):
        keys = [(sip.start - 0.5, 0.0), (sip.at(0.5), 1.0), (sip.end, 0.7), (sip.end + 0.7, 0.0)]
        head[:, 0] += (0.22 + 0.06 * script.random.normal()) * script.track(keys)
    return script.upright_stance(trunk, head)


def _table(script: Script) -> tuple[Furniture, Array]:
    """A small table at the right hand, of a height that suits, and the mug's place on it (3,)."""
    x, y = script.place(0.31, 0.30)
    top = script.table_top(0.525)
    table = side_table(x + 0.08, y + 0.10, top)
    return (*table, *script.seat), np.array([x, y, top + MUG_HEIGHT / 2.0])


def _grip(script: Script) -> Transform:
    """A fist around the handle, the cup ahead of it and to its left: object_from_hand (T)."""
    handle = np.array([0.0, MUG_RADIUS + MUG_HANDLE_REACH, 0.0])
    return hold_bar(script, handle, rotation_about("z", FIST_TURN + script.person.manner.grip_turn))


def _carry(script: Script, trunk: Trunk, spot: Array) -> Transform:
    """The mug's way, world_from_object (T).

    Its turn about the vertical is chosen for the hand: fingers ahead at the table, to the left at
    the mouth.
    """
    manner, random = script.person.manner, script.random

    def turned(fingers_to_left: float) -> Array:
        return rotation_about("z", fingers_to_left - FIST_TURN - manner.grip_turn)

    on_table = Transform(spot, turned(FINGERS_AT_TABLE + random.normal(0.0, 0.1)))
    on_table = script.still(on_table)
    at_mouth = _sip(script, trunk, turned(FINGERS_AT_MOUTH))
    chest = upright(trunk.world_from_chest)

    def before_chest(_: Stage) -> Transform:
        offset = np.array([0.13, 0.30, -0.27]) * manner.amplitude + random.normal(0.0, 0.02, 3)
        wander = script.drifts(0.008, 3.0)
        held = Transform(offset, turned(FINGERS_CARRIED + random.normal(0.0, 0.1)))
        return Transform(wander, np.eye(3)) @ chest @ held

    goals = {
        "lift": To(before_chest, bow=(0.0, 0.03, 0.02)),
        "raise": To(at_mouth, bow=(0.0, 0.05, 0.0)),
        "lower": To(before_chest, bow=(0.0, 0.03, 0.02)),
        "return": To(on_table, bow=(0.0, -0.02, 0.05)),
    }
    return script.way(on_table, goals)


def _sip(script: Script, trunk: Trunk, turn: Array) -> Transform:
    """The mug's rim at the lips, world_from_object (T), tilted further as it empties."""
    tilt = np.full(len(script.times), 0.2)
    for sip in script.every("sip"):
        deepest = min(0.55 + 0.15 * sip.repetition + 0.08 * script.random.normal(), 1.1)
        keys = [(sip.start, 0.0), (sip.at(0.45), 1.0), (sip.end - 0.2, 0.9), (sip.end + 0.3, 0.0)]
        tilt += deepest * script.track(keys)
    tilted = rotation_about("z", heading_of(trunk.world_from_head)) @ rotation_about("x", tilt)
    near_rim = np.array([0.0, -MUG_RADIUS, MUG_HEIGHT / 2.0])
    return Transform(mouth(script.person, trunk) - tilted @ near_rim, tilted @ turn)
