"""putOnShoe: on a stool, take a shoe from the floor, put it on, tap the foot, take it off again.

The right hand does it while the left one holds on to its lower leg. While the shoe is on, it moves
with the foot and is worn.
"""

from __future__ import annotations

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import Transform, rotation_about, rotation_from_axes
from inhand_lab.motions.furniture import WOOD, Cuboid
from inhand_lab.motions.grips import pinch
from inhand_lab.motions.performance import STANCE_HALF_WIDTH, ContactKind, Performance
from inhand_lab.motions.reaching import carried_by
from inhand_lab.motions.script import Script, To, write_script
from inhand_lab.motions.timeline import Move, Pause, Plan
from inhand_lab.objects.shoe import HEEL_BEHIND
from inhand_lab.people.kinematics import Posture
from inhand_lab.people.person import SimulatedPerson

PLAN = Plan(
    opening=(Pause("wait", 0.4), Move("reach", 0.9), Move("grasp", 0.25), Move("lift", 0.9)),
    use=(
        Move("put on", 1.2),
        Move("let go", 0.8),
        Pause("wear", 0.5),
        Move("tap", 1.2),
        Pause("wear", 0.4),
        Move("take hold", 0.9),
        Move("take off", 1.0),
    ),
    closing=(Move("return", 0.9), Move("release", 0.2), Move("withdraw", 0.9), Pause("wait", 0.4)),
)

SEAT, BEHIND = 0.285, 0.12
"""Height of the hip joints, and how far they are behind the world's origin, in statures."""
STOOL = 0.34
UNDER_HIPS = 0.050
"""The stool's top below the hip joints, in statures."""
BENT_TO_FLOOR, BENT_TO_FOOT, UPRIGHT = 1.38, 1.27, 0.06
"""Lean of the trunk, radians."""
RAISED = np.array([-0.030, 0.06, 0.11])
"""The foot's way inward, forward and up, in statures."""
TOES_UP = 0.20
TAP = 0.28
"""How far the toes are lifted to tap, radians."""

AT_TOES = Transform(np.array([0.0, 0.20, -0.08]), rotation_about("x", 0.35))
HALF_ON = Transform(np.array([0.0, 0.07, -0.05]), rotation_about("x", 0.18))
"""The shoe on its way to the foot, foot_from_object."""

COLLAR_GRIP = np.array([0.034, -0.046, 0.078])
RIGHT_BOW, LEFT_BOW = (0.12, 0.06, 0.13), (-0.06, 0.10, 0.10)
ON_COLLAR = rotation_from_axes([-0.60, 0.30, -0.75], [-0.25, 0.95, 0.35])
"""Where the right hand holds the shoe, and its rotation in the shoe's frame."""
ON_KNEE = rotation_from_axes([-0.25, 1.0, -0.15], [-1.0, -0.25, 0.0])
BESIDE_SHANK = rotation_from_axes([0.0, 0.25, -1.0], [0.0, 1.0, 0.25])
"""A right hand's rotation on the thigh and at the outer side of the lower leg, in the world."""


def perform(person: SimulatedPerson, times: Array, random: np.random.Generator) -> Performance:
    """Putting on a shoe at these times, in seconds from the start."""
    script = write_script(person, times, random, PLAN)
    right_foot = _right_foot(script)
    posture = _sit(script, right_foot)
    carried = _carry(script, right_foot)
    held = carried @ _grip(script)
    right_rest, left_rest = _hands_on_knees(script)
    right_hand = _reaching(script, right_rest, held, RIGHT_BOW)
    left_hand = _reaching(script, left_rest, _left_hand_on_leg(script), LEFT_BOW)
    contact = carried_by(script, *_changes(script))
    return Performance(
        posture, right_hand, left_hand, carried, contact, (_stool(person),), script.stages
    )


def _changes(script: Script) -> list[tuple[float, ContactKind]]:
    """When the shoe passes from the hand to the foot and back."""
    return [
        (stage.start, ContactKind.WORN)
        if stage.name == "let go"
        else (stage.end, ContactKind.RIGHT_HAND)
        for stage in script.every("let go", "take hold")
    ]


def _right_foot(script: Script) -> Transform:
    """The right foot, world_from_foot (T): raised to the hands; on its heel, the toes tapping."""
    person, times, random = script.person, script.times, script.random
    raised = [(0.0, (0.0,))]
    tapped = np.zeros(len(times))
    for stage in script.stages:
        if stage.name in ("lift", "take hold"):
            raised += [(stage.at(0.3), (0.0,)), (stage.end, (1.0,))]
        if stage.name in ("let go", "return"):
            raised += [(stage.start, (1.0,)), (stage.at(0.65), (0.0,))]
        if stage.name == "tap":
            taps = int(random.integers(2, 5))
            share = np.clip((times - stage.start) / stage.seconds, 0.0, 1.0)
            tapped = TAP * random.uniform(0.6, 1.1) * np.sin(np.pi * taps * share) ** 2
    up = script.flow(raised)[:, 0]
    on_floor = np.array([STANCE_HALF_WIDTH, _feet_ahead(person), 0.0])
    heel = np.array([0.0, -HEEL_BEHIND, 0.0])
    flat = rotation_about("z", -person.carriage.toes_out)
    rotation = rotation_about("xz", TOES_UP * up + tapped, -person.carriage.toes_out)
    place = on_floor + flat @ heel - rotation @ heel + up[:, None] * RAISED * person.height
    return Transform(place, rotation)


def _feet_ahead(person: SimulatedPerson) -> float:
    return person.proportions.thigh - BEHIND * person.height


def _sit(script: Script, right_foot: Transform) -> Posture:
    """A posture on the stool, bent to the floor and to the foot, the left foot on the floor."""
    person, manner = script.person, script.person.manner
    trunk = _lean(script) + script.drifts(0.02, 5.0) + [manner.stoop, 0.0, 0.0]
    pelvis = rotation_about("x", -0.35 * trunk[:, 0])
    hips = np.array([0.0, -BEHIND, SEAT]) * person.height
    head = script.drifts(0.05, 3.0) + trunk[:, :1] / BENT_TO_FOOT * [0.25, 0.0, -0.05]
    head[:, :2] += [manner.head_pitch, person.carriage.head_aside]
    left_foot = np.array([-STANCE_HALF_WIDTH, _feet_ahead(person), 0.0])
    return Posture(
        Transform(hips + pelvis[:, :, 2] * person.proportions.hip_drop, pelvis),
        trunk * (0.65, 1.0, 1.0),
        head,
        right_foot,
        script.still(Transform(left_foot, rotation_about("z", person.carriage.toes_out))),
    )


def _lean(script: Script) -> Array:
    """How the trunk leans (T, 3), radians, as its angles in Posture."""
    knots = [(0.0, (UPRIGHT, 0.0, 0.0))]
    for stage in script.stages:
        goal = {
            "reach": (BENT_TO_FLOOR, 0.15, 0.15),
            "lift": (BENT_TO_FOOT, 0.0, 0.0),
            "let go": (UPRIGHT + script.random.uniform(0.0, 0.3), 0.0, 0.0),
            "take hold": (BENT_TO_FOOT, 0.0, 0.0),
            "return": (BENT_TO_FLOOR, 0.15, 0.15),
            "withdraw": (UPRIGHT, 0.0, 0.0),
        }.get(stage.name)
        if goal is not None:
            knots += [(stage.start, knots[-1][1]), (stage.end, goal)]
    return script.flow(knots)


def _stool(person: SimulatedPerson) -> Cuboid:
    """The stool, its top just under the thighs."""
    high = (SEAT - UNDER_HIPS) * person.height
    return Cuboid((0.0, -BEHIND * person.height - 0.05, 0.5 * high), (STOOL, STOOL, high), WOOD)


def _hands_on_knees(script: Script) -> tuple[Transform, Transform]:
    """The right and the left hand, world_from_hand (T), on the thighs near the knees."""
    person, body = script.person, script.person.proportions
    above = 0.040 * person.height * person.girth + 0.030
    hands = []
    for _ in range(2):
        back = script.random.uniform(0.06, 0.12)
        place = np.array([STANCE_HALF_WIDTH + 0.04, _feet_ahead(person) - back, 0.0])
        place[2] = body.ankle + body.shank + above
        hands.append(script.still(Transform(place, ON_KNEE)))
    return hands[0], hands[1].mirrored()


def _left_hand_on_leg(script: Script) -> Transform:
    """The left hand, world_from_hand (T), at the outer side of the left lower leg."""
    person, body = script.person, script.person.proportions
    aside = 0.028 * person.height * person.girth + 0.078
    place = [STANCE_HALF_WIDTH + aside, _feet_ahead(person) + 0.02, body.ankle + 0.55 * body.shank]
    return script.still(Transform(np.array(place), BESIDE_SHANK)).mirrored()


def _grip(script: Script) -> Transform:
    """Thumb and fingers on the collar near the heel, object_from_hand (T)."""
    manner = script.person.manner
    slid = np.array([0.0, 0.012 * manner.grip_slide, 0.0])
    turned = ON_COLLAR @ rotation_about("x", 0.5 * manner.grip_turn)
    return pinch(script, COLLAR_GRIP + slid, turned)


def _reaching(
    script: Script, rest: Transform, busy: Transform, bow: tuple[float, float, float]
) -> Transform:
    """A hand, world_from_hand (T), from its knee to where it works while the trunk is bent."""
    there, back = To(busy, bow), To(rest, bow)
    goals = {"reach": there, "let go": back, "take hold": there, "withdraw": back}
    return script.way(rest, goals)


def _carry(script: Script, right_foot: Transform) -> Transform:
    """The shoe's way, world_from_object (T): from the floor to the toes, on, off and back."""
    person, random = script.person, script.random
    x, ahead = np.array([0.11, 0.035]) * person.height + random.normal(0.0, 0.015, 2)
    place = np.array([x + 0.04, _feet_ahead(person) + ahead, 0.0])
    on_floor = script.still(Transform(place, rotation_about("z", random.normal(-0.1, 0.12))))
    goals = {
        "lift": To(right_foot @ AT_TOES, bow=(0.04, 0.02, 0.06)),
        "put on": To(right_foot, by=right_foot @ HALF_ON),
        "take off": To(right_foot @ AT_TOES, by=right_foot @ HALF_ON),
        "return": To(on_floor, bow=(0.04, 0.02, 0.07)),
    }
    return script.way(on_floor, goals)
