"""shakeVinegar: take a bottle from a table, shake it over a plate in bursts, put it back."""

from __future__ import annotations

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import Transform, rotation_about
from inhand_lab.motions.furniture import Cuboid, Furniture, side_table
from inhand_lab.motions.grips import hold_bar
from inhand_lab.motions.performance import Performance, Stance, feet_apart, hanging_hands, stand
from inhand_lab.motions.reaching import (
    PUT_BACK,
    TAKE,
    attention,
    held_by_right_hand,
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
from inhand_lab.objects.vinegar_bottle import BOTTLE_HALF_HEIGHT, BOTTLE_RADIUS
from inhand_lab.people.kinematics import place_trunk
from inhand_lab.people.person import SimulatedPerson

OPENING = (*TAKE, Move("lift", 0.85))
USE = (
    Move("tip", 0.55),
    Move("shake", 1.05),
    Move("right", 0.45),
    Pause("look", 0.5),
)
CLOSING = PUT_BACK

IN_FIST = np.array([-0.015 - BOTTLE_RADIUS, 0.022, 0.0])
"""Where the bottle's axis passes through the hand."""

FINGERS_AT_TABLE, FINGERS_AT_PLATE = 0.15, 0.50
"""Where the fingers point, as turns to the left from straight ahead, radians."""

HELD_TILT, TIPPED = 0.55, 2.10
"""Tilt of the bottle to the left between bursts and while shaking, radians."""
SHAKES_A_SECOND = 3.5
SHAKE, SHAKE_TILT = 0.022, 0.13
"""A shake along the bottle, metres, and about the forearm, radians, to either side."""

PLATE_SIZE, PLATE_HEIGHT = 0.25, 0.018
CHINA, CHIPS = (232, 234, 238), (226, 178, 84)


def perform(person: SimulatedPerson, times: Array, random: np.random.Generator) -> Performance:
    """Shaking vinegar at these times, in seconds from the start."""
    stages = schedule(person, random, float(times[-1]), OPENING, USE, CLOSING)
    posture = stand(person, times, random, _stance(times, stages))
    trunk = place_trunk(person, posture)
    furniture, spot, plate = _table(person, random)
    carried = _carry(person, times, random, spot, plate, stages)
    point = np.array([0.0, 0.0, -0.015 + 0.02 * person.manner.grip_slide])
    square = rotation_about("z", person.manner.grip_turn)
    grip = hold_bar(person, times, random, point, square, IN_FIST)
    right_rest, left_rest = hanging_hands(person, trunk, random)
    return Performance(
        posture,
        reaching_hand(times, stages, right_rest, carried @ grip, bow=(0.07, -0.05, 0.08)),
        left_rest,
        carried,
        held_by_right_hand(times, stages),
        furniture,
    )


def _stance(times: Array, stages: list[Stage]) -> Stance:
    """A look at the bottle, and down at the plate while at work."""
    count = len(times)
    lift, back = named(stages, "lift"), named(stages, "return")
    keys = [(lift.start, 0.0), (lift.end, 1.0), (back.start, 1.0), (back.end, 0.0)]
    looked, worked = attention(times, stages)[:, None], track(times, keys)[:, None]
    trunk = looked * np.array([0.10, 0.03, -0.12]) + worked * np.array([0.10, -0.02, 0.05])
    head = looked * np.array([-0.30, 0.0, -0.25]) + worked * np.array([-0.40, 0.0, 0.08])
    right_foot, left_foot = feet_apart(count)
    return Stance(right_foot, left_foot, np.zeros(count), np.zeros((count, 3)), trunk, head)


def _table(person: SimulatedPerson, random: np.random.Generator) -> tuple[Furniture, Array, Array]:
    """A table ahead, the bottle's place on it (3,) and the middle of the plate (3,)."""
    size = person.height / 1.75
    top = 0.53 * person.height + random.normal(0.0, 0.015)
    across, ahead = np.array([0.27, 0.38]) * size + random.normal(0.0, 0.015, 2)
    spot = np.array([across, ahead, top + BOTTLE_HALF_HEIGHT])
    x, y = np.array([-0.07, 0.40]) * size + random.normal(0.0, 0.015, 2)
    height = top + PLATE_HEIGHT
    narrow = 0.68 * PLATE_SIZE
    served = (
        Cuboid((x, y, top + PLATE_HEIGHT / 2.0), (PLATE_SIZE, narrow, PLATE_HEIGHT), CHINA),
        Cuboid((x, y, top + PLATE_HEIGHT / 2.0), (narrow, PLATE_SIZE, PLATE_HEIGHT), CHINA),
        Cuboid((x, y, height + 0.010), (0.13, 0.11, 0.020), CHIPS),
    )
    table = side_table(0.10, 0.24 * size + 0.20, top, width=0.75)
    return (*table, *served), spot, np.array([x, y, height])


def _carry(
    person: SimulatedPerson,
    times: Array,
    random: np.random.Generator,
    spot: Array,
    plate: Array,
    stages: list[Stage],
) -> Transform:
    """The bottle's way, world_from_object (T): over the plate it points to the left and down."""

    from_fingers = rotation_about("z", -person.manner.grip_turn)

    def on_table() -> Transform:
        place = spot + np.append(random.normal(0.0, 0.012, 2), 0.0)
        turned = rotation_about("z", FINGERS_AT_TABLE + random.normal(0.0, 0.1))
        return Transform(place, turned @ from_fingers).repeated(len(times))

    first, last = on_table(), on_table()
    tipped = _tilt(person, times, random, stages)
    shaken = _shakes(person, times, random, stages)
    nod = 0.10 + drift(times, random, 0.04, 2.0)
    turn = FINGERS_AT_PLATE + random.normal(0.0, 0.1) + drift(times, random, 0.06, 3.0)
    tilt = tipped + SHAKE_TILT * shaken
    rotation = rotation_about("yxz", -tilt, -nod, turn) @ from_fingers
    wander = np.stack([drift(times, random, 0.018, 2.0) for _ in range(3)], axis=1)
    over = 1.0 - (tipped - HELD_TILT) / (TIPPED - HELD_TILT)
    above = np.outer(0.13 * person.manner.amplitude + 0.10 * over, [0.0, 0.0, 1.0])
    aside = np.outer(0.02 + 0.05 * over, [1.0, 0.0, 0.0])
    sprinkler = plate + above + aside + wander * [1.0, 1.0, 0.6]
    middle = sprinkler + rotation[:, :, 2] * (SHAKE * shaken - BOTTLE_HALF_HEIGHT)[:, None]
    lift, back = named(stages, "lift"), named(stages, "return")
    return move_through(
        times,
        [
            Key(lift.start, first),
            Key(lift.end, Transform(middle, rotation), bow=(0.0, -0.02, 0.05)),
            Key(back.start, Transform(middle, rotation)),
            Key(back.end, last, bow=(0.0, -0.02, 0.06)),
        ],
    )


def _tilt(
    person: SimulatedPerson, times: Array, random: np.random.Generator, stages: list[Stage]
) -> Array:
    """The bottle's tilt (T,) to the left without the shakes, radians."""
    own = TIPPED + 0.25 * (person.manner.amplitude - 1.0)
    keys = [(0.0, HELD_TILT)]
    for stage in stages:
        if stage.name == "tip":
            deepest = own + 0.08 * float(random.normal())
            keys += [(stage.start, keys[-1][1]), (stage.end, deepest)]
        if stage.name == "right":
            held = HELD_TILT + 0.12 * float(random.normal())
            keys += [(stage.start, keys[-1][1]), (stage.end, held)]
    return track(times, keys)


def _shakes(
    person: SimulatedPerson, times: Array, random: np.random.Generator, stages: list[Stage]
) -> Array:
    """Where (T,) the bottle is in its shakes, -1 to 1 for a person of average amplitude."""
    shaken = np.zeros(len(times))
    for stage in stages:
        if stage.name == "shake":
            rate = SHAKES_A_SECOND * person.manner.tempo * float(np.exp(random.normal(0.0, 0.06)))
            swell = 0.2 * (stage.end - stage.start)
            keys = [
                (stage.start, 0.0),
                (stage.start + swell, 1.0),
                (stage.end - swell, 1.0),
                (stage.end, 0.0),
            ]
            shaken += track(times, keys) * np.sin(2.0 * np.pi * rate * (times - stage.start))
    return person.manner.amplitude * shaken
