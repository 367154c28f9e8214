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
    contacts,
    feet_apart,
    hanging_hands,
    heading_of,
    stand,
)
from inhand_lab.motions.reaching import named
from inhand_lab.motions.steps import Turn, turn_on_the_spot
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
from inhand_lab.objects.barbell import BAR_RADIUS
from inhand_lab.people.kinematics import Trunk, place_trunk
from inhand_lab.people.person import SimulatedPerson

OPENING = (
    Pause("wait", 0.4),
    Move("stoop", 1.2),
    Move("grasp", 0.25),
    Move("rise", 1.25),
)
USE = (
    Pause("hang", 0.35),
    Move("curl", 0.7),
    Pause("squeeze", 0.15),
    Move("lower", 0.75),
)
CLOSING = (
    Pause("hang", 0.35),
    Move("return", 1.25),
    Move("release", 0.2),
    Move("withdraw", 1.15),
    Pause("wait", 0.3),
)

STANCE_HALF_WIDTH = 0.125
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
    stages = schedule(person, random, float(times[-1]), OPENING, USE, CLOSING)
    stool = _stool(person, random)
    curled = _curls(times, random, stages)
    posture = stand(person, times, random, _stance(person, times, stages, stool, curled))
    trunk = place_trunk(person, posture)
    carried = _carry(person, times, random, trunk, stages, stool, curled)
    right_rest, left_rest = hanging_hands(person, trunk, random)
    right_held = carried @ _grip(person, times, random)
    left_held = carried @ _grip(person, times, random).mirrored()
    stoop, withdraw = named(stages, "stoop"), named(stages, "withdraw")
    reach = stoop.start + 0.3 * (stoop.end - stoop.start)

    def hand(rest: Transform, held: Transform) -> Transform:
        released = withdraw.start + 0.8 * (withdraw.end - withdraw.start)
        return move_through(
            times,
            [
                Key(reach, rest),
                Key(stoop.end, held),
                Key(withdraw.start, held),
                Key(released, rest),
            ],
        )

    changes = [
        (0.0, ContactKind.RESTING),
        (named(stages, "grasp").end, ContactKind.BOTH_HANDS),
        (named(stages, "release").start, ContactKind.RESTING),
    ]
    return Performance(
        posture,
        hand(right_rest, right_held),
        hand(left_rest, left_held),
        carried,
        contacts(times, changes),
        stool.furniture,
    )


def _stool(person: SimulatedPerson, random: np.random.Generator) -> Stool:
    """A stool ahead and to the right."""
    heading = -float(np.clip(random.normal(0.95, 0.15), 0.65, 1.25))
    ahead = 0.44 * person.height / 1.75 + float(random.normal(0.0, 0.01))
    return Stool(heading, ahead, float(random.normal(0.50, 0.02)))


def _grip(person: SimulatedPerson, times: Array, random: np.random.Generator) -> Transform:
    """The right fist around the bar from below, object_from_hand (T)."""
    wide = max(person.proportions.shoulder_half_width + 0.035, 0.125 * person.height * person.girth)
    aside = wide + 0.02 * person.manner.grip_slide
    turned = rotation_about("x", 0.6 * person.manner.grip_turn) @ UNDERHAND
    return hold_bar(person, times, random, np.array([aside, 0.0, 0.0]), turned)


def _stance(
    person: SimulatedPerson, times: Array, stages: list[Stage], stool: Stool, curled: Array
) -> Stance:
    """Turning and stooping to the stool at both ends; leaning back a little with the weight."""
    stoop, rise = named(stages, "stoop"), named(stages, "rise")
    back, withdraw = named(stages, "return"), named(stages, "withdraw")

    def during(stage: Stage, share: float) -> float:
        return stage.start + share * (stage.end - stage.start)

    turns = [
        Turn(stoop.start, during(stoop, 0.6), stool.heading),
        Turn(during(rise, 0.35), rise.end, 0.0),
        Turn(back.start, during(back, 0.6), stool.heading),
        Turn(during(withdraw, 0.4), withdraw.end, 0.0),
    ]
    footing = turn_on_the_spot(times, STANCE_HALF_WIDTH, turns)
    stooped = track(
        times,
        [
            (during(stoop, 0.25), 0.0),
            (stoop.end, 1.0),
            (rise.start, 1.0),
            (during(rise, 0.75), 0.0),
            (during(back, 0.25), 0.0),
            (back.end, 1.0),
            (withdraw.start, 1.0),
            (during(withdraw, 0.8), 0.0),
        ],
    )
    shift = np.outer(stooped, [0.0, 0.0, -_knees_bent(person, stool)])
    shift -= HIPS_BACK * stooped[:, None] * rotation_about("z", footing.heading)[:, :, 1]
    trunk = np.outer(stooped, [LEAN, 0.0, 0.0]) - np.outer(curled, [0.07, 0.0, 0.0])
    glance = track(
        times,
        [
            (time, value)
            for stage in (stoop, back)
            for time, value in (
                (stage.start - 0.2, 0.0),
                (during(stage, 0.4), 1.0),
                (during(stage, 0.9), 0.0),
            )
        ],
    )
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
    right_foot, left_foot = feet_apart(1, STANCE_HALF_WIDTH)
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


def _curls(times: Array, random: np.random.Generator, stages: list[Stage]) -> Array:
    """How far (T,) the bar is lifted from hanging, 0, to the chest, about 1."""
    keys = [(0.0, 0.0)]
    for stage in stages:
        if stage.name == "curl":
            top = 1.0 + 0.05 * float(random.normal())
            keys += [(stage.start, 0.0), (stage.end, top)]
        if stage.name == "lower":
            keys += [(stage.start, keys[-1][1]), (stage.end, 0.0)]
    return track(times, keys)


def _carry(
    person: SimulatedPerson,
    times: Array,
    random: np.random.Generator,
    trunk: Trunk,
    stages: list[Stage],
    stool: Stool,
    curled: Array,
) -> Transform:
    """The bar's way, world_from_object (T): it turns with the forearms."""
    body = person.proportions
    fist = body.forearm + body.palm + float(BAR_IN_PALM[1])
    before_belly = 0.066 * person.height * person.girth + 0.055
    sine = (before_belly - body.upper_arm * np.sin(UPPER_ARM_HANGING)) / fist
    hanging = float(np.arcsin(np.clip(sine, 0.0, 0.7)))
    upper = UPPER_ARM_HANGING + (UPPER_ARM_CURLED - UPPER_ARM_HANGING) * curled
    fore = hanging + (FOREARM_CURLED - hanging) * curled
    ahead = body.upper_arm * np.sin(upper) + fist * np.sin(fore)
    down = body.upper_arm * np.cos(upper) + fist * np.cos(fore)
    offset = STRAIGHT * np.stack([np.zeros(len(times)), ahead, -down], axis=1)
    upright = rotation_about("z", heading_of(trunk.world_from_chest))
    shoulders = 0.5 * (trunk.right_shoulder + trunk.left_shoulder)
    level = rotation_about("xy", fore, drift(times, random, 0.015, 3.0))
    held = Transform(shoulders, upright) @ Transform(offset, level)
    rise, back = named(stages, "rise"), named(stages, "return")
    first, last = ((stool.world_from_bar @ _laid(random)).repeated(len(times)) for _ in range(2))
    return move_through(
        times,
        [
            Key(rise.start, first),
            Key(rise.start + 0.6 * (rise.end - rise.start), held, bow=(0.0, 0.0, 0.04)),
            Key(back.start + 0.5 * (back.end - back.start), held),
            Key(back.end, last, bow=(0.0, 0.0, 0.04)),
        ],
    )


def _laid(random: np.random.Generator) -> Transform:
    """The bar as it lies, from where it would lie straight across the middle."""
    slide, aside = random.normal(0.0, (0.015, 0.008))
    roll, turn = random.normal((0.3, 0.0), (0.1, 0.04))
    return Transform(np.array([slide, aside, 0.0]), rotation_about("xz", roll, turn))
