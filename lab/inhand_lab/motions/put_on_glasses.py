"""putOnGlasses: take glasses from a side table, put them on, look about, take them off again."""

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
from inhand_lab.motions.grips import pinch
from inhand_lab.motions.performance import ContactKind, Performance, Stance, hanging_hands, upright
from inhand_lab.motions.reaching import attention, carried_by
from inhand_lab.motions.script import Script, To, write_script
from inhand_lab.motions.timeline import Move, Pause, Plan, Stage
from inhand_lab.objects.glasses import EAR_DROP, TEMPLE_OFFSET
from inhand_lab.people.kinematics import Trunk
from inhand_lab.people.person import SimulatedPerson

PLAN = Plan(
    opening=(Pause("wait", 0.4), Move("reach", 0.9), Move("grasp", 0.25), Move("fetch", 1.0)),
    use=(
        Pause("inspect", 0.5),
        Move("put on", 1.3),
        Move("let go", 0.8),
        Pause("wear", 1.4),
        Move("take hold", 0.8),
        Move("take off", 1.1),
    ),
    closing=(
        Pause("inspect", 0.4),
        Move("return", 1.0),
        Move("release", 0.25),
        Move("withdraw", 0.9),
        Pause("wait", 0.4),
    ),
    on_stool=True,
)

FACE_GRIP = rotation_from_axes([-0.20, -0.60, 0.75], [-0.2, -0.75, -0.6])
TABLE_GRIP = rotation_from_axes([-0.30, 0.70, -0.65], [-0.9, -0.2, 0.5])
"""The right hand's rotation in the glasses' frame: fingers up at the face, ahead at the table."""

RAISED = Transform(
    np.array([0.20, 0.28, -0.06]), rotation_from_axes([-0.15, 0.9, 0.3], [0, 0, 1.0])
)
"""Where the right hand passes on its way between thigh and face, from the upright chest."""


def perform(person: SimulatedPerson, times: Array, random: np.random.Generator) -> Performance:
    """Putting on glasses at these times, in seconds from the start."""
    script = write_script(person, times, random, PLAN)
    posture, trunk = script.stand(_stance(script))
    table, spot = _table(script)
    carried = _carry(script, trunk, spot)
    right_held = carried @ _grip(script)
    left_held = carried @ _grip(script).mirrored()
    right_rest, left_rest = hanging_hands(person, trunk, random)
    chest = upright(trunk.world_from_chest)
    right_hand = script.way(right_rest, _fetch(right_rest, right_held, chest @ RAISED))
    left_hand = script.way(left_rest, _help(left_rest, left_held, chest @ RAISED.mirrored()))
    contact = carried_by(script, *_changes(script))
    return Performance(posture, right_hand, left_hand, carried, contact, table, script.stages)


def _fetch(rest: Transform, held: Transform, raised: Transform) -> dict[str, To]:
    """The right hand fetches the glasses and returns them."""
    return {
        "reach": To(held, bow=(0.0, -0.06, 0.12)),
        "let go": To(rest, by=raised),
        "take hold": To(held, by=raised),
        "withdraw": To(rest, bow=(0.0, -0.12, 0.12)),
    }


def _help(rest: Transform, held: Transform, raised: Transform) -> dict[str, To]:
    """The left hand joins before the chest and helps at the face."""
    return {
        "fetch": To(held, bow=(-0.05, 0.05, 0.0), part=(0.25, 1.0)),
        "let go": To(rest, by=raised),
        "take hold": To(held, by=raised),
        "return": To(rest, bow=(-0.05, 0.05, 0.0)),
    }


def _changes(script: Script) -> list[tuple[float, ContactKind]]:
    """When the glasses pass from a hand to both, to the head, and back."""
    changes = []
    for stage in script.every("fetch", "let go", "take hold", "return"):
        if stage.name == "let go":
            changes.append((stage.start, ContactKind.WORN))
        elif stage.name == "return":
            changes.append((stage.start, ContactKind.RIGHT_HAND))
        else:
            changes.append((stage.end, ContactKind.BOTH_HANDS))
    return changes


def _stance(script: Script) -> Stance:
    """A look at the table and at the glasses; a look about while wearing them."""
    random = script.random
    looked = attention(script)
    trunk, head = np.outer(looked, [0.10, 0.03, -0.15]), np.outer(looked, [-0.30, 0.0, -0.35])
    for stage in script.every("inspect"):
        head[:, 0] -= 0.35 * script.around(stage, 0.5, 0.5)
    for stage in script.every("wear"):
        aside, up = random.uniform(0.15, 0.45) * random.choice([-1.0, 1.0]), random.normal() / 9
        turns = ((0.0, 0.0), (1.0 / 3.0, 1.0), (2.0 / 3.0, -0.7), (1.0, 0.0))
        about = script.track([(stage.at(share), turn) for share, turn in turns])
        head += np.outer(about, [up, 0.0, aside])
    return script.upright_stance(trunk, head)


def _table(script: Script) -> tuple[Furniture, Array]:
    """A small table at the right hand, and where the glasses' bridge is as they lie on it (3,)."""
    x, y = script.place(0.24, 0.37)
    top = script.table_top(0.53)
    table = side_table(x + 0.15, y + 0.09, top)
    return (*table, *script.seat), np.array([x, y, top + EAR_DROP + 0.004])


def _grip(script: Script) -> Transform:
    """Thumb and fingers at a hinge, object_from_hand (T); they are shifted on the way to the face.

    Between the table and the face the hand turns about the pinched temple.
    """
    manner = script.person.manner
    point = np.array([TEMPLE_OFFSET, -0.022 - 0.012 * manner.grip_slide, 0.006])
    turn = rotation_about("y", 0.6 * manner.grip_turn)
    at_table = pinch(script, point, turn @ TABLE_GRIP)
    at_face = pinch(script, point, turn @ FACE_GRIP)
    between = interpolate(at_table, at_face, np.full(len(script.times), 0.5))
    goals = {
        "fetch": To(between),
        "put on": To(at_face),
        "take off": To(between),
        "return": To(at_table),
    }
    return script.way(at_table, goals)


def _carry(script: Script, trunk: Trunk, spot: Array) -> Transform:
    """The glasses' way, world_from_object (T)."""
    body, random = script.person.proportions, script.random
    on_table = script.still(Transform(spot, rotation_about("z", random.normal(0.1, 0.15))))
    slipped = rotation_about("x", random.normal(-0.05, 0.03))
    bridge = np.array([0.0, body.head_half_depth + 0.012, 0.12 * body.head_half_height])
    ahead = bridge + np.array([0.0, 0.14, 0.01])
    worn = trunk.world_from_head @ Transform(bridge, slipped)
    before_face = trunk.world_from_head @ Transform(ahead, rotation_about("x", -0.1))
    chest = upright(trunk.world_from_chest)

    def before_chest(_: Stage) -> Transform:
        offset = np.array([0.0, 0.36, -0.16 * script.person.manner.amplitude])
        offset += random.normal(0.0, 0.02, 3)
        tipped = rotation_about("xz", -0.45 + random.normal(0.0, 0.1), random.normal(0.0, 0.1))
        return chest @ Transform(offset, tipped)

    near = To(before_face, bow=(0.0, 0.03, 0.0), part=(0.0, 0.6))
    away = To(before_face, part=(0.0, 0.4))
    goals: dict[str, To | tuple[To, ...]] = {
        "fetch": To(before_chest, bow=(0.0, 0.0, 0.05)),
        "put on": (near, To(worn, part=(0.6, 1.0))),
        "take off": (away, To(before_chest, part=(0.4, 1.0))),
        "return": To(on_table, bow=(0.0, 0.0, 0.05)),
    }
    return script.way(on_table, goals)
