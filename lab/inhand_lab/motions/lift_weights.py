"""liftWeights: turn and stoop to a stool, take a weights bar, curl it, put it back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import Transform, rotation_about, rotation_from_axes
from inhand_lab.motions.furniture import WOOD, Cuboid, Furniture
from inhand_lab.motions.grips import BAR_IN_PALM, hold_bar
from inhand_lab.motions.performance import (
    ContactKind,
    Performance,
    Stance,
    feet_apart,
    hanging_hands,
    stand,
    upright,
)
from inhand_lab.motions.reaching import carried_by
from inhand_lab.motions.script import Script, To, write_script
from inhand_lab.motions.steps import Turn, turn_on_the_spot
from inhand_lab.motions.timeline import Move, Pause, Plan, Stage
from inhand_lab.objects.barbell import BAR_RADIUS
from inhand_lab.people.kinematics import Trunk, place_trunk
from inhand_lab.people.person import SimulatedPerson

PLAN = Plan(
    opening=(Pause("wait", 0.4), Move("stoop", 1.2), Move("grasp", 0.25), Move("rise", 1.25)),
    use=(Pause("hang", 0.35), Move("curl", 0.7), Pause("squeeze", 0.15), Move("lower", 0.75)),
    closing=(
        Pause("hang", 0.35),
        Move("return", 1.25),
        Move("release", 0.2),
        Move("withdraw", 1.15),
        Pause("wait", 0.3),
    ),
)

FEET_HALF_APART = 0.125
STOOL_SIZE = 0.22
UNDERHAND = rotation_from_axes([0.0, 0.0, -1.0], [1.0, 0.0, 0.0])
"""The right hand's rotation in the bar's frame: with hanging arms the palm is ahead."""

UPPER_ARM_HANGING, UPPER_ARM_CURLED = 0.10, 0.26
"""Angles of the upper arms ahead of the vertical, radians."""
FOREARM_CURLED = 2.35
"""Angle of the forearms ahead of the vertical at the top of a curl, radians."""
LEAN = 0.95
"""Of the stooping trunk, radians, before the person's own."""
HIPS_BACK = 0.10
"""How far the hips go back to keep the balance, metres."""
STRAIGHT = 0.97
"""Share of their length to which the arms hang with the weight."""

LATE = (0.25, 1.0)
"""The part of a stoop in which the trunk bends: turning to the stool comes first."""


@dataclass(frozen=True)
class Stool:
    """A stool with the bar across it.

    heading is the turn to the left, radians, with which the body faces it; ahead is the bar's
    distance from there and height its height above the floor, metres.
    """

    heading: float
    ahead: float
    height: float

    @property
    def world_from_bar(self) -> Transform:
        """The bar as it lies, square to the person who faces it."""
        turned = rotation_about("z", self.heading)
        place = turned @ np.array([0.0, self.ahead, self.height])
        return Transform(place, turned)

    @property
    def furniture(self) -> Furniture:
        """Seat, leg and foot."""
        x, y, _ = (float(value) for value in self.world_from_bar.translation)
        top = self.height - BAR_RADIUS
        return (
            Cuboid((x, y, top - 0.025), (STOOL_SIZE, STOOL_SIZE, 0.05), (52, 50, 56)),
            Cuboid((x, y, 0.5 * top), (0.05, 0.05, top - 0.06), WOOD),
            Cuboid((x, y, 0.015), (STOOL_SIZE, STOOL_SIZE, 0.03), WOOD),
        )


def perform(person: SimulatedPerson, times: Array, random: np.random.Generator) -> Performance:
    """Lifting weights at these times, in seconds from the start."""
    script = write_script(person, times, random, PLAN)
    stool = _stool(script)
    curled = _curls(script)
    posture, trunk = script.stand(_stance(script, stool, curled))
    carried = _carry(script, trunk, stool, curled)
    right_rest, left_rest = hanging_hands(person, trunk, random)
    right_held = carried @ _grip(script)
    left_held = carried @ _grip(script).mirrored()
    right_hand = _take_hold(script, right_rest, right_held)
    left_hand = _take_hold(script, left_rest, left_held)
    contact = carried_by(script, taken=ContactKind.BOTH_HANDS)
    return Performance(
        posture, right_hand, left_hand, carried, contact, stool.furniture, script.stages
    )


def _take_hold(script: Script, rest: Transform, held: Transform) -> Transform:
    """A hand, world_from_hand (T): on the bar from the end of stooping to it to the last rise."""
    goals = {"stoop": To(held, part=(0.3, 1.0)), "withdraw": To(rest, part=(0.0, 0.8))}
    return script.way(rest, goals)


def _stool(script: Script) -> Stool:
    """A stool ahead and to the right."""
    random = script.random
    heading = -float(np.clip(random.normal(0.95, 0.15), 0.65, 1.25))
    ahead = 0.44 * script.size + float(random.normal(0.0, 0.01))
    return Stool(heading, ahead, float(random.normal(0.50, 0.02)))


def _grip(script: Script) -> Transform:
    """The right fist around the bar from below, object_from_hand (T)."""
    person, manner = script.person, script.person.manner
    wide = max(person.proportions.shoulder_half_width + 0.035, 0.125 * person.height * person.girth)
    point = np.array([wide + 0.02 * manner.grip_slide, 0.0, 0.0])
    return hold_bar(script, point, rotation_about("x", 0.6 * manner.grip_turn) @ UNDERHAND)


def _stance(script: Script, stool: Stool, curled: Array) -> Stance:
    """Turning and stooping to the stool at both ends; leaning back a little with the weight."""
    stoop, rise = script.stage("stoop"), script.stage("rise")
    back, withdraw = script.stage("return"), script.stage("withdraw")
    turns = [
        Turn(stoop.start, stoop.at(0.6), stool.heading),
        Turn(rise.at(0.35), rise.end, 0.0),
        Turn(back.start, back.at(0.6), stool.heading),
        Turn(withdraw.at(0.4), withdraw.end, 0.0),
    ]
    footing = turn_on_the_spot(script.times, FEET_HALF_APART, turns)
    stooped = script.level(
        0.0,
        {"stoop": 1.0, "rise": 0.0, "return": 1.0, "withdraw": 0.0},
        parts={"stoop": LATE, "rise": (0.0, 0.75), "return": LATE, "withdraw": (0.0, 0.8)},
    )
    shift = np.outer(stooped, [0.0, 0.0, -_knees_bent(script.person, stool)])
    shift -= HIPS_BACK * stooped[:, None] * rotation_about("z", footing.heading)[:, :, 1]
    trunk = np.outer(stooped, [LEAN, 0.0, 0.0]) - np.outer(curled, [0.07, 0.0, 0.0])
    glance = np.zeros(len(script.times))
    for stage in (stoop, back):
        keys = [(stage.start - 0.2, 0.0), (stage.at(0.4), 1.0), (stage.at(0.9), 0.0)]
        glance += script.track(keys)
    head = np.outer(glance, [-0.15, 0.0, -0.5]) + np.outer(stooped, [0.25, 0.0, 0.0])
    return Stance(
        footing.right_foot,
        footing.left_foot,
        footing.heading,
        shift,
        trunk,
        head,
        footing.foot_turns,
    )


def _knees_bent(person: SimulatedPerson, stool: Stool) -> float:
    """How far the hips go down, metres, until the arms reach the bar from a stooping trunk."""
    right_foot, left_foot = feet_apart(person, 1, FEET_HALF_APART)
    back, stooped = np.array([[0.0, -HIPS_BACK, 0.0]]), np.array([[LEAN, 0.0, 0.0]])
    stance = Stance(right_foot, left_foot, np.zeros(1), back, stooped, np.zeros((1, 3)))
    trunk = place_trunk(person, stand(person, np.zeros(1), np.random.default_rng(0), stance))
    _, ahead, height = 0.5 * (trunk.right_shoulder + trunk.left_shoulder)[0]
    reach = 0.90 * _arm_length(person)
    above = np.sqrt(reach**2 - (stool.ahead - ahead) ** 2)
    return max(float(height - stool.height - above), 0.0)


def _arm_length(person: SimulatedPerson) -> float:
    """Shoulder to a bar in the fist, metres."""
    body = person.proportions
    return body.upper_arm + body.forearm + body.palm + float(BAR_IN_PALM[1])


def _curls(script: Script) -> Array:
    """How far (T,) the bar is lifted from hanging, 0, to the chest, about 1."""

    def top(_: Stage) -> float:
        return 1.0 + 0.05 * float(script.random.normal())

    return script.level(0.0, {"curl": top, "lower": 0.0})


def _carry(script: Script, trunk: Trunk, stool: Stool, curled: Array) -> Transform:
    """The bar's way, world_from_object (T): from the stool to the hanging arms and back."""
    held = _hang(script, trunk, curled)
    lying = stool.world_from_bar
    first, last = (script.still(lying @ _laid(script.random)) for _ in range(2))
    goals = {
        "rise": To(held, bow=(0.0, 0.0, 0.04), part=(0.0, 0.6)),
        "return": To(last, bow=(0.0, 0.0, 0.04), part=(0.5, 1.0)),
    }
    return script.way(first, goals)


def _hang(script: Script, trunk: Trunk, curled: Array) -> Transform:
    """The bar in the hands, world_from_object (T): it turns with the forearms."""
    person, body = script.person, script.person.proportions
    fist = body.forearm + body.palm + float(BAR_IN_PALM[1])
    before_belly = 0.066 * person.height * person.girth + 0.055
    sine = (before_belly - body.upper_arm * np.sin(UPPER_ARM_HANGING)) / fist
    hanging = float(np.arcsin(np.clip(sine, 0.0, 0.7)))
    upper = UPPER_ARM_HANGING + (UPPER_ARM_CURLED - UPPER_ARM_HANGING) * curled
    fore = hanging + (FOREARM_CURLED - hanging) * curled
    ahead = body.upper_arm * np.sin(upper) + fist * np.sin(fore)
    down = body.upper_arm * np.cos(upper) + fist * np.cos(fore)
    offset = STRAIGHT * np.stack([0.0 * ahead, ahead, -down], axis=1)
    shoulders = 0.5 * (trunk.right_shoulder + trunk.left_shoulder)
    level = rotation_about("xy", fore, script.drift(0.015, 3.0))
    facing = upright(trunk.world_from_chest).rotation
    return Transform(shoulders, facing) @ Transform(offset, level)


def _laid(random: np.random.Generator) -> Transform:
    """The bar as it lies, from where it would lie straight across the middle."""
    slide, aside = random.normal(0.0, (0.015, 0.008))
    roll, turn = random.normal((0.3, 0.0), (0.1, 0.04))
    return Transform(np.array([slide, aside, 0.0]), rotation_about("xz", roll, turn))
