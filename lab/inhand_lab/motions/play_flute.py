"""playFlute: take a flute from a table, play it to the right of the face, rest, put it back."""

from __future__ import annotations

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import (
    Transform,
    interpolate,
    rotation_about,
    rotation_from_axes,
)
from inhand_lab.motions.furniture import Furniture, side_table
from inhand_lab.motions.grips import hold_bar
from inhand_lab.motions.performance import (
    ContactKind,
    Performance,
    Stance,
    hanging_hands,
    mouth,
    upright,
)
from inhand_lab.motions.reaching import PUT_BACK, TAKE, attention, carried_by, reaching_hand
from inhand_lab.motions.script import Script, To, write_script
from inhand_lab.motions.timeline import Move, Pause, Plan, Stage
from inhand_lab.objects.flute import EMBOUCHURE, TUBE_RADIUS
from inhand_lab.people.kinematics import Trunk
from inhand_lab.people.person import SimulatedPerson

PLAN = Plan(
    opening=(*TAKE, Move("fetch", 1.0)),
    use=(Move("raise", 0.8), Pause("play", 1.3), Move("lower", 0.75), Pause("rest", 0.4)),
    closing=PUT_BACK,
    on_stool=True,
)

RIGHT_HAND, LEFT_HAND = 0.125, -0.095
"""Where the hands are along the flute, metres."""
UNDER_RIGHT_FINGERS = np.array([-0.030, 0.062, 0.0])
UNDER_LEFT_FINGERS = np.array([-0.030, 0.046, 0.020])
"""Where the flute is in the hands, between thumb and fingers."""

CROWN = [0.0, -1.0, 0.0]
RIGHT_AT_TABLE = rotation_from_axes([-0.75, 0.0, -0.65], CROWN)
RIGHT_AT_LIPS = rotation_from_axes([-0.78, 0.0, 0.62], CROWN)
LEFT_AT_REST = rotation_from_axes([0.40, 0.0, 0.92], CROWN)
LEFT_AT_LIPS = rotation_from_axes([-0.53, 0.0, 0.85], CROWN)
"""The hands' rotations in the flute's frame, the left one's mirrored: the right fingers come from
the player's side, the left hand is on the far one, its palm to the player."""

FOOT_TO_THE_RIGHT = rotation_from_axes([1.0, 0.0, 0.0], [0.0, 0.0, 1.0])
"""The flute level before somebody, its keys up."""

AROUND_TABLE = (-0.15, 0.0, 0.06)
"""How the left hand's way to the flute and back swings out."""


def perform(person: SimulatedPerson, times: Array, random: np.random.Generator) -> Performance:
    """Playing the flute at these times, in seconds from the start."""
    script = write_script(person, times, random, PLAN)
    posture, trunk = script.stand(_stance(script))
    table, spot = _table(script)
    carried = _carry(script, trunk, spot)
    right_rest, left_rest = hanging_hands(person, trunk, random)
    right_held = carried @ _right_grip(script)
    right_hand = reaching_hand(script, right_rest, right_held, bow=(0.06, -0.06, 0.14))
    goals = {
        "fetch": To(carried @ _left_grip(script), AROUND_TABLE, part=(0.25, 1.0)),
        "return": To(left_rest, AROUND_TABLE, part=(0.0, 0.8)),
    }
    left_hand = script.way(left_rest, goals)
    joining = (script.stage("fetch").end, ContactKind.BOTH_HANDS)
    leaving = (script.stage("return").start, ContactKind.RIGHT_HAND)
    contact = carried_by(script, joining, leaving)
    return Performance(posture, right_hand, left_hand, carried, contact, table, script.stages)


def _stance(script: Script) -> Stance:
    """A look at the table; the face turned over the left shoulder and a sway while playing."""
    looked, played = attention(script)[:, None], _playing(script)[:, None]
    bow, lean, twist, nod = (
        script.person.manner.amplitude * script.drift(deviation, period)
        for deviation, period in ((0.045, 1.6), (0.045, 2.2), (0.07, 2.5), (0.04, 1.2))
    )
    trunk = looked * [0.10, 0.03, -0.12] + played * [0.02, 0.0, -0.33]
    trunk += played * np.stack([bow, lean, twist], axis=1)
    head = looked * [-0.30, 0.0, -0.25] + played * [-0.08, 0.10, 0.38]
    head += played * np.stack([nod, 0.4 * lean, 0.3 * twist], axis=1)
    shift = played * np.outer(lean, [0.25, 0.0, 0.0])
    return script.upright_stance(trunk, head, shift, half_width=0.10)


def _playing(script: Script) -> Array:
    """How much (T,), 0 to 1, the flute is at the lips."""
    return script.level(0.0, {"raise": 1.0, "lower": 0.0})


def _table(script: Script) -> tuple[Furniture, Array]:
    """A table ahead, and where the flute's middle is as it lies on it (3,)."""
    x, y = script.place(0.14, 0.42)
    top = script.table_top(0.53)
    table = side_table(0.14, y + 0.09, top, width=0.80)
    return (*table, *script.seat), np.array([x, y, top + TUBE_RADIUS + 0.003])


def _right_grip(script: Script) -> Transform:
    """Thumb and fingers of the right hand, object_from_hand (T), rolled from above to beside."""
    at_table, at_lips = _holds(
        script, RIGHT_HAND, (RIGHT_AT_TABLE, RIGHT_AT_LIPS), UNDER_RIGHT_FINGERS
    )
    rolled = script.way(at_table, {"fetch": To(at_lips), "return": To(at_table)})
    return rolled @ _fingering(script)


def _left_grip(script: Script) -> Transform:
    """Thumb and fingers of the left hand, object_from_hand (T), rolled up to the lips."""
    at_rest, at_lips = _holds(script, LEFT_HAND, (LEFT_AT_REST, LEFT_AT_LIPS), UNDER_LEFT_FINGERS)
    rolled = interpolate(at_rest, at_lips, _playing(script))
    return (rolled @ _fingering(script)).mirrored()


def _holds(
    script: Script, along: float, rotations: tuple[Array, Array], in_hand: Array
) -> list[Transform]:
    """A hand's two ways to hold the flute at one place, object_from_hand (T)."""
    manner = script.person.manner
    point = np.array([0.0, along + 0.015 * manner.grip_slide, 0.0])
    turn = rotation_about("y", 0.3 * manner.grip_turn)
    return [hold_bar(script, point, turn @ rotation, in_hand) for rotation in rotations]


def _fingering(script: Script) -> Transform:
    """What moving fingers do to the back of their hand, a transform (T) of some degrees."""
    angles = script.drifts(0.03, 0.5, count=2)
    return Transform(np.zeros((len(angles), 3)), rotation_about("xz", *angles.T))


def _carry(script: Script, trunk: Trunk, spot: Array) -> Transform:
    """The flute's way, world_from_object (T): its embouchure stays at the lips while playing."""
    person, random = script.person, script.random
    yaw, roll = random.normal((0.10, 0.0), (0.12, 0.2))
    lying = rotation_about("xz", roll, yaw) @ FOOT_TO_THE_RIGHT
    on_table = script.still(Transform(spot, lying))
    at_lips = _at_lips(script, trunk)
    chest = upright(trunk.world_from_chest)
    ahead = 0.165 + 0.12 * person.height * person.girth

    def before_chest(_: Stage) -> Transform:
        offset = np.array([-0.02, ahead, -0.23 * person.manner.amplitude])
        offset += random.normal(0.0, 0.015, 3)
        tipped = rotation_about("xyz", *random.normal((-0.6, 0.15, 0.20), 0.10))
        return chest @ Transform(offset, tipped @ FOOT_TO_THE_RIGHT)

    goals = {
        "fetch": To(before_chest, bow=(0.0, 0.08, 0.03)),
        "raise": To(at_lips, bow=(0.0, 0.10, 0.0)),
        "lower": To(before_chest, bow=(0.0, 0.08, 0.03)),
        "return": To(on_table, bow=(0.0, -0.02, 0.06)),
    }
    return script.way(on_table, goals)


def _at_lips(script: Script, trunk: Trunk) -> Transform:
    """The flute as it is played, world_from_object (T)."""
    person = script.person
    droop = 0.20 + 0.15 * person.manner.grip_tilt + script.drift(0.04, 2.5)
    yaw = 0.20 + max(person.girth - 1.0, 0.0) + script.drift(0.04, 3.0)
    roll = 0.15 + 0.4 * person.manner.grip_turn + script.drift(0.03, 2.0)
    rolled = FOOT_TO_THE_RIGHT @ rotation_about("y", roll)
    rotation = trunk.world_from_head.rotation @ rotation_about("yz", droop, yaw) @ rolled
    lips = Transform(mouth(person, trunk), trunk.world_from_head.rotation)
    hole = lips.apply(np.array([0.0, 0.012, -0.004]))
    return Transform(hole - rotation @ np.array([0.0, EMBOUCHURE, TUBE_RADIUS]), rotation)
