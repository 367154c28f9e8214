"""recordVideo: take a camera from a table, hold it up with both hands, film, pan, put it back."""

from __future__ import annotations

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import Transform, interpolate, rotation_about
from inhand_lab.motions.furniture import Furniture, side_table
from inhand_lab.motions.grips import hold_bar
from inhand_lab.motions.performance import (
    ContactKind,
    Performance,
    Stance,
    hanging_hands,
    heading_of,
    upright,
)
from inhand_lab.motions.reaching import PUT_BACK, TAKE, attention, carried_by, reaching_hand
from inhand_lab.motions.script import Script, To, write_script
from inhand_lab.motions.timeline import Key, Move, Pause, Plan, Stage, move_through
from inhand_lab.objects.camera import CAMERA_HEIGHT, GRIP_OFFSET
from inhand_lab.people.kinematics import Trunk
from inhand_lab.people.person import SimulatedPerson

PLAN = Plan(
    opening=(*TAKE, Move("fetch", 1.0), Pause("ready", 0.3), Move("raise", 1.0)),
    use=(Pause("film", 0.9), Move("pan", 1.1), Pause("film", 0.9), Move("pan", 1.1)),
    closing=(Pause("film", 1.0), Move("lower", 1.0), Pause("ready", 0.3), *PUT_BACK),
)

INWARDS = np.radians(25.0)
"""Turn of the fingers around the camera's front."""
STEEP_AT_TABLE, STEEP_AT_FACE = np.radians(-22.0), np.radians(50.0)
"""Where the fingers point above the camera's axis: the hands shift their hold while lifting."""

BEFORE_FACE = np.array([0.0, 0.30, 0.030])
BEFORE_CHEST = np.array([0.03, 0.32, -0.19])
"""The camera from the middle of the head and from the shoulder centre, metres."""
USUAL_PAN = 0.50
"""To either side, radians."""
AROUND_TABLE = (-0.08, 0.12, 0.0)
"""How the left hand's way to the camera and back swings out, metres."""


def perform(person: SimulatedPerson, times: Array, random: np.random.Generator) -> Performance:
    """Filming at these times, in seconds from the start."""
    script = write_script(person, times, random, PLAN)
    pan, tilt = _aim(script)
    posture, trunk = script.stand(_stance(script, pan, tilt))
    table, spot = _table(script)
    carried = _carry(script, trunk, spot, tilt)
    right_held = carried @ _grip(script)
    left_held = carried @ _grip(script).mirrored()
    right_rest, left_rest = hanging_hands(person, trunk, random)
    right_hand = reaching_hand(script, right_rest, right_held, bow=(0.06, -0.10, 0.16))
    left_hand = _join(script, left_rest, left_held)
    joined = (script.stage("fetch").end, ContactKind.BOTH_HANDS)
    leaving = (script.stage("lower").end, ContactKind.RIGHT_HAND)
    contact = carried_by(script, joined, leaving)
    return Performance(posture, right_hand, left_hand, carried, contact, table, script.stages)


def _aim(script: Script) -> tuple[Array, Array]:
    """Where the camera is meant to look: its turn to the left and up (T,), radians."""
    random = script.random
    side = random.choice([-1.0, 1.0])
    level = random.normal(-0.03, 0.05)
    aims = {}
    for stage in script.every("pan"):
        reach = script.person.manner.amplitude * USUAL_PAN * random.uniform(0.6, 1.1)
        aims[stage] = (side * reach, level + random.normal(0.0, 0.06))
        side = -side
    pan = script.level(0.0, {"pan": lambda stage: aims[stage][0], "lower": 0.0})
    return pan, script.level(level, {"pan": lambda stage: aims[stage][1], "lower": level})


def _stance(script: Script, pan: Array, tilt: Array) -> Stance:
    """A look at the table; the body turns with the camera, the weight goes with it."""
    looked = attention(script)
    raised = script.level(0.0, {"raise": 1.0, "lower": 0.0})
    trunk = np.outer(looked, [0.10, 0.03, -0.15]) + np.outer(pan, [0.0, 0.0, 0.75])
    trunk -= np.outer(raised, [0.05, 0.0, 0.0])
    head = np.outer(looked, [-0.28, 0.0, -0.35]) + np.outer(pan, [0.0, 0.0, 0.25])
    head += np.outer(raised * (0.10 + 0.5 * tilt), [1.0, 0.0, 0.0])
    return script.upright_stance(trunk, head, np.outer(pan, [-0.04, 0.0, 0.0]), half_width=0.11)


def _table(script: Script) -> tuple[Furniture, Array]:
    """A small table at the right hand and the camera's place on it (3,)."""
    x, y = script.place(0.28, 0.34)
    top = script.table_top(0.525)
    return side_table(x + 0.10, y + 0.10, top), np.array([x, y, top + CAMERA_HEIGHT / 2.0])


def _grip(script: Script) -> Transform:
    """The right hand about the camera's side, thumb behind, object_from_hand (T)."""
    manner = script.person.manner
    inwards = INWARDS + 0.4 * manner.grip_turn
    at_table, at_face = (
        hold_bar(
            script,
            np.array([GRIP_OFFSET, 0.0, up + 0.008 * manner.grip_slide]),
            rotation_about("zx", inwards, steep),
        )
        for up, steep in ((0.025, STEEP_AT_TABLE), (0.0, STEEP_AT_FACE))
    )
    shifted = script.level(0.0, {"fetch": 0.5, "raise": 1.0, "lower": 0.5, "return": 0.0})
    return interpolate(at_table, at_face, shifted)


def _carry(script: Script, trunk: Trunk, spot: Array, tilt: Array) -> Transform:
    """The camera's way, world_from_object (T)."""
    random = script.random
    on_table = script.still(Transform(spot, rotation_about("z", random.normal(-0.12, 0.12))))
    filming = _film(script, trunk, tilt)
    chest = upright(trunk.world_from_chest)

    def before_chest(_: Stage) -> Transform:
        offset = BEFORE_CHEST + random.normal(0.0, 0.02, 3)
        tipped = rotation_about("xz", -0.30 + random.normal(0.0, 0.1), random.normal(0.0, 0.1))
        return chest @ Transform(offset, tipped)

    lifted = (0.0, 0.02, 0.03)
    goals = {
        "fetch": To(before_chest, lifted),
        "raise": To(filming, lifted),
        "lower": To(before_chest, lifted),
        "return": To(on_table, lifted),
    }
    return script.way(on_table, goals)


def _film(script: Script, trunk: Trunk, tilt: Array) -> Transform:
    """The camera before the face, world_from_object (T), in hands that are not quite still."""
    ahead = BEFORE_FACE * (1.0, script.person.manner.amplitude, 1.0)
    ahead += script.random.normal(0.0, 0.02, 3)
    shake = script.drifts(0.003, 1.5)
    unsteady = script.drifts(0.02, 1.5, count=2)
    aimed = rotation_about("xz", tilt + unsteady[:, 0], unsteady[:, 1])
    turned = rotation_about("z", heading_of(trunk.world_from_head))
    place = trunk.world_from_head.translation + turned @ ahead + shake
    return Transform(place, turned @ aimed)


def _join(script: Script, rest: Transform, held: Transform) -> Transform:
    """The left hand, world_from_hand (T), at the camera from before the chest to there again."""
    fetch, lower, back = (script.stage(name) for name in ("fetch", "lower", "return"))
    keys = [
        Key(fetch.at(0.2), rest),
        Key(fetch.end, held, AROUND_TABLE),
        Key(lower.end, held),
        Key(back.end, rest, AROUND_TABLE),
    ]
    return move_through(script.times, keys)
