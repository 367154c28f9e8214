"""drinkFromMug: take a mug from a side table, drink from it now and then, put it back."""

from __future__ import annotations

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import Transform, rotation_about
from inhand_lab.motions.furniture import Furniture, side_table
from inhand_lab.motions.grips import hold_bar
from inhand_lab.motions.performance import (
    ContactKind,
    Performance,
    Stance,
    contacts,
    feet_apart,
    hanging_hands,
    heading_of,
    mouth,
    stand,
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
from inhand_lab.objects.mug import MUG_HANDLE_REACH, MUG_HEIGHT, MUG_RADIUS
from inhand_lab.people.kinematics import Trunk, place_trunk
from inhand_lab.people.person import SimulatedPerson

OPENING = (
    Pause("wait", 0.5),
    Move("reach", 1.0),
    Move("grasp", 0.25),
    Move("lift", 0.9),
)
USE = (
    Pause("hold", 0.6),
    Move("raise", 0.9),
    Move("sip", 1.3),
    Move("lower", 0.9),
)
CLOSING = (
    Pause("hold", 0.6),
    Move("return", 1.0),
    Move("release", 0.25),
    Move("withdraw", 1.0),
    Pause("wait", 0.5),
)

FIST_TURN = np.radians(135.0)
"""Turn of the fist about the handle in the mug's frame: the cup is ahead and to the left."""

FINGERS_AT_TABLE, FINGERS_CARRIED, FINGERS_AT_MOUTH = 0.25, 0.80, 1.40
"""Where the fingers point, as turns to the left from straight ahead, radians."""


def perform(person: SimulatedPerson, times: Array, random: np.random.Generator) -> Performance:
    """Drinking at these times, in seconds from the start."""
    stages = schedule(person, random, float(times[-1]), OPENING, USE, CLOSING)
    posture = stand(person, times, random, _stance(person, times, random, stages))
    trunk = place_trunk(person, posture)
    table, spot = _table(person, random)
    grip = _grip(person, times, random)
    carried = _carry(person, times, random, trunk, spot, stages)
    held = carried @ grip
    start = {stage.name: stage.start for stage in stages}
    end = {stage.name: stage.end for stage in stages}
    rest, left_hand = hanging_hands(person, trunk, random)
    right_hand = move_through(
        times,
        [
            Key(start["reach"], rest),
            Key(end["reach"], held, bow=(0.06, -0.05, 0.10)),
            Key(start["withdraw"], held),
            Key(end["withdraw"], rest, bow=(0.06, -0.05, 0.08)),
        ],
    )
    contact = contacts(
        times,
        [
            (0.0, ContactKind.RESTING),
            (end["grasp"], ContactKind.RIGHT_HAND),
            (start["release"], ContactKind.RESTING),
        ],
    )
    return Performance(posture, right_hand, left_hand, carried, contact, table)


def _stance(
    person: SimulatedPerson, times: Array, random: np.random.Generator, stages: list[Stage]
) -> Stance:
    """A look and a twist to the table, and the head back while drinking."""
    count = len(times)
    trunk, head = np.zeros((count, 3)), np.zeros((count, 3))
    for stage in stages:
        if stage.name in ("reach", "return"):
            middle, back = stage.end, stage.end + 1.2
            looked = track(times, [(stage.start, 0.0), (middle, 1.0), (back, 0.0)])
            head += looked[:, None] * np.array([-0.30, 0.0, -0.35])
            trunk += looked[:, None] * np.array([0.10, 0.03, -0.15])
        if stage.name == "sip":
            top = 0.5 * (stage.start + stage.end)
            keys = [(stage.start - 0.5, 0.0), (top, 1.0), (stage.end, 0.7), (stage.end + 0.7, 0.0)]
            head[:, 0] += (0.22 + 0.06 * random.normal()) * track(times, keys)
    right_foot, left_foot = feet_apart(count)
    return Stance(right_foot, left_foot, np.zeros(count), np.zeros((count, 3)), trunk, head)


def _table(person: SimulatedPerson, random: np.random.Generator) -> tuple[Furniture, Array]:
    """A small table at the right hand, of a height that suits, and the mug's place on it (3,)."""
    size = person.height / 1.75
    x, y = np.array([0.31, 0.30]) * size + random.normal(0.0, 0.015, 2)
    top = 0.525 * person.height + random.normal(0.0, 0.015)
    spot = np.array([x, y, top + MUG_HEIGHT / 2.0])
    return side_table(x + 0.08, y + 0.10, top), spot


def _grip(person: SimulatedPerson, times: Array, random: np.random.Generator) -> Transform:
    """A fist around the handle, the cup ahead of it and to its left: object_from_hand (T)."""
    handle = np.array([0.0, MUG_RADIUS + MUG_HANDLE_REACH, 0.0])
    square = rotation_about("z", FIST_TURN + person.manner.grip_turn)
    return hold_bar(person, times, random, handle, square)


def _carry(
    person: SimulatedPerson,
    times: Array,
    random: np.random.Generator,
    trunk: Trunk,
    spot: Array,
    stages: list[Stage],
) -> Transform:
    """The mug's way, world_from_object (T).

    Its turn about the vertical is chosen for the hand: fingers ahead at the table, to the left at
    the mouth.
    """
    count = len(times)
    fist = FIST_TURN + person.manner.grip_turn

    def turned(fingers_to_left: float) -> Array:
        return rotation_about("z", fingers_to_left - fist)

    on_table = Transform(spot, turned(FINGERS_AT_TABLE + random.normal(0.0, 0.1))).repeated(count)
    at_mouth = _sipping(person, times, random, trunk, stages, turned(FINGERS_AT_MOUTH))
    upright = rotation_about("z", heading_of(trunk.world_from_chest))

    def held_before_chest() -> Transform:
        offset = np.array([0.13, 0.30, -0.27]) * person.manner.amplitude
        offset = offset + random.normal(0.0, 0.02, 3)
        wander = np.stack([drift(times, random, 0.008, 3.0) for _ in range(3)], axis=1)
        place = trunk.world_from_chest.translation + upright @ offset + wander
        return Transform(place, upright @ turned(FINGERS_CARRIED + random.normal(0.0, 0.1)))

    keys = [Key(0.0, on_table)]
    for stage in stages:
        if stage.name in ("lift", "lower"):
            here = held_before_chest()
            keys += [Key(stage.start, keys[-1].pose), Key(stage.end, here, bow=(0.0, 0.03, 0.02))]
        if stage.name == "raise":
            keys += [Key(stage.start, keys[-1].pose), Key(stage.end, at_mouth, bow=(0, 0.05, 0))]
        if stage.name == "return":
            lowered = (0.0, -0.02, 0.05)
            keys += [Key(stage.start, keys[-1].pose), Key(stage.end, on_table, bow=lowered)]
    return move_through(times, keys)


def _sipping(
    person: SimulatedPerson,
    times: Array,
    random: np.random.Generator,
    trunk: Trunk,
    stages: list[Stage],
    turn: Array,
) -> Transform:
    """The mug's rim at the lips, world_from_object (T), tilted further as it empties."""
    tilt = np.full(len(times), 0.2)
    for stage in stages:
        if stage.name == "sip":
            deepest = min(0.55 + 0.15 * stage.repetition + 0.08 * random.normal(), 1.1)
            top = stage.start + 0.45 * (stage.end - stage.start)
            keys = [(stage.start, 0.0), (top, 1.0), (stage.end - 0.2, 0.9), (stage.end + 0.3, 0.0)]
            tilt += deepest * track(times, keys)
    upright = rotation_about("z", heading_of(trunk.world_from_head))
    tilted = upright @ rotation_about("x", tilt)
    near_rim = np.array([0.0, -MUG_RADIUS, MUG_HEIGHT / 2.0])
    return Transform(mouth(person, trunk) - tilted @ near_rim, tilted @ turn)
