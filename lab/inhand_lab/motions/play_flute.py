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
    contacts,
    feet_apart,
    hanging_hands,
    heading_of,
    mouth,
    stand,
)
from inhand_lab.motions.reaching import PUT_BACK, TAKE, attention, named, reaching_hand
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
from inhand_lab.objects.flute import EMBOUCHURE, TUBE_RADIUS
from inhand_lab.people.kinematics import Trunk, place_trunk
from inhand_lab.people.person import SimulatedPerson

OPENING = (*TAKE, Move("fetch", 1.0))
USE = (Move("raise", 0.8), Pause("play", 1.3), Move("lower", 0.75), Pause("rest", 0.4))
CLOSING = PUT_BACK

RIGHT_HAND, LEFT_HAND = 0.125, -0.095
"""Where the hands are along the flute."""
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
    stages = schedule(person, random, float(times[-1]), OPENING, USE, CLOSING)
    posture = stand(person, times, random, _stance(person, times, random, stages))
    trunk = place_trunk(person, posture)
    table, spot = _table(person, random)
    carried = _carry(person, times, random, trunk, spot, stages)
    right_rest, left_rest = hanging_hands(person, trunk, random)
    right_held = carried @ _right_grip(person, times, random, stages)
    left_held = carried @ _left_grip(person, times, random, stages)
    fetch, back = named(stages, "fetch"), named(stages, "return")
    left_hand = move_through(
        times,
        [
            Key(fetch.start + 0.25 * (fetch.end - fetch.start), left_rest),
            Key(fetch.end, left_held, bow=AROUND_TABLE),
            Key(back.start, left_held),
            Key(back.start + 0.8 * (back.end - back.start), left_rest, bow=AROUND_TABLE),
        ],
    )
    changes = [
        (0.0, ContactKind.RESTING),
        (named(stages, "grasp").end, ContactKind.RIGHT_HAND),
        (fetch.end, ContactKind.BOTH_HANDS),
        (back.start, ContactKind.RIGHT_HAND),
        (named(stages, "release").start, ContactKind.RESTING),
    ]
    return Performance(
        posture,
        reaching_hand(times, stages, right_rest, right_held, bow=(0.06, -0.06, 0.14)),
        left_hand,
        carried,
        contacts(times, changes),
        table,
    )


def _stance(
    person: SimulatedPerson, times: Array, random: np.random.Generator, stages: list[Stage]
) -> Stance:
    """A look at the table; the face turned over the left shoulder and a sway while playing."""
    count = len(times)
    looked, played = attention(times, stages)[:, None], _playing(times, stages)[:, None]
    bow, lean, twist, nod = (
        person.manner.amplitude * drift(times, random, deviation, period)
        for deviation, period in ((0.045, 1.6), (0.045, 2.2), (0.07, 2.5), (0.04, 1.2))
    )
    trunk = looked * np.array([0.10, 0.03, -0.12]) + played * np.array([0.02, 0.0, -0.33])
    trunk += played * np.stack([bow, lean, twist], axis=1)
    head = looked * np.array([-0.30, 0.0, -0.25]) + played * np.array([-0.08, 0.10, 0.38])
    head += played * np.stack([nod, 0.4 * lean, 0.3 * twist], axis=1)
    shift = played * np.stack([0.25 * lean, np.zeros(count), np.zeros(count)], axis=1)
    right_foot, left_foot = feet_apart(count, half_width=0.10)
    return Stance(right_foot, left_foot, np.zeros(count), shift, trunk, head)


def _playing(times: Array, stages: list[Stage]) -> Array:
    """How much (T,), 0 to 1, the flute is at the lips."""
    keys = [(0.0, 0.0)]
    for stage in stages:
        if stage.name == "raise":
            keys += [(stage.start, 0.0), (stage.end, 1.0)]
        if stage.name == "lower":
            keys += [(stage.start, 1.0), (stage.end, 0.0)]
    return track(times, keys)


def _table(person: SimulatedPerson, random: np.random.Generator) -> tuple[Furniture, Array]:
    """A table ahead, and where the flute's middle is as it lies on it (3,)."""
    size = person.height / 1.75
    x, y = np.array([0.14, 0.42]) * size + random.normal(0.0, 0.015, 2)
    top = 0.53 * person.height + random.normal(0.0, 0.015)
    return side_table(0.14, y + 0.09, top, width=0.80), np.array([x, y, top + TUBE_RADIUS + 0.003])


def _right_grip(
    person: SimulatedPerson, times: Array, random: np.random.Generator, stages: list[Stage]
) -> Transform:
    """Thumb and fingers of the right hand, object_from_hand (T), rolled from above to beside."""
    point = np.array([0.0, RIGHT_HAND + 0.015 * person.manner.grip_slide, 0.0])
    turn = rotation_about("y", 0.3 * person.manner.grip_turn)
    at_table, at_lips = (
        hold_bar(person, times, random, point, turn @ rotation, UNDER_RIGHT_FINGERS)
        for rotation in (RIGHT_AT_TABLE, RIGHT_AT_LIPS)
    )
    fetch, back = named(stages, "fetch"), named(stages, "return")
    rolled = move_through(
        times,
        [
            Key(fetch.start, at_table),
            Key(fetch.end, at_lips),
            Key(back.start, at_lips),
            Key(back.end, at_table),
        ],
    )
    return rolled @ _fingering(times, random)


def _left_grip(
    person: SimulatedPerson, times: Array, random: np.random.Generator, stages: list[Stage]
) -> Transform:
    """Thumb and fingers of the left hand, object_from_hand (T), rolled up to the lips."""
    point = np.array([0.0, LEFT_HAND + 0.015 * person.manner.grip_slide, 0.0])
    turn = rotation_about("y", 0.3 * person.manner.grip_turn)
    at_rest, at_lips = (
        hold_bar(person, times, random, point, turn @ rotation, UNDER_LEFT_FINGERS)
        for rotation in (LEFT_AT_REST, LEFT_AT_LIPS)
    )
    rolled = interpolate(at_rest, at_lips, _playing(times, stages))
    return (rolled @ _fingering(times, random)).mirrored()


def _fingering(times: Array, random: np.random.Generator) -> Transform:
    """What moving fingers do to the back of their hand, a transform (T) of some degrees."""
    angles = [drift(times, random, 0.03, 0.5) for _ in range(2)]
    return Transform(np.zeros((len(times), 3)), rotation_about("xz", *angles))


def _carry(
    person: SimulatedPerson,
    times: Array,
    random: np.random.Generator,
    trunk: Trunk,
    spot: Array,
    stages: list[Stage],
) -> Transform:
    """The flute's way, world_from_object (T): its embouchure stays at the lips while playing."""
    count = len(times)
    yaw, roll = random.normal((0.10, 0.0), (0.12, 0.2))
    on_table = Transform(spot, rotation_about("xz", roll, yaw) @ FOOT_TO_THE_RIGHT).repeated(count)
    at_lips = _at_lips(person, times, random, trunk)
    upright = rotation_about("z", heading_of(trunk.world_from_chest))
    ahead = 0.165 + 0.12 * person.height * person.girth

    def before_chest() -> Transform:
        offset = np.array([-0.02, ahead, -0.23 * person.manner.amplitude])
        place = upright @ (offset + random.normal(0.0, 0.015, 3))
        roll, droop, yaw = random.normal((-0.6, 0.15, 0.20), 0.10)
        tipped = rotation_about("xyz", roll, droop, yaw) @ FOOT_TO_THE_RIGHT
        return Transform(trunk.world_from_chest.translation + place, upright @ tipped)

    keys = [Key(0.0, on_table)]
    for stage in stages:
        here = Key(stage.start, keys[-1].pose)
        if stage.name in ("fetch", "lower"):
            keys += [here, Key(stage.end, before_chest(), bow=(0.0, 0.08, 0.03))]
        if stage.name == "raise":
            keys += [here, Key(stage.end, at_lips, bow=(0.0, 0.10, 0.0))]
        if stage.name == "return":
            keys += [here, Key(stage.end, on_table, bow=(0.0, -0.02, 0.06))]
    return move_through(times, keys)


def _at_lips(
    person: SimulatedPerson, times: Array, random: np.random.Generator, trunk: Trunk
) -> Transform:
    """The flute as it is played, world_from_object (T)."""
    droop = 0.20 + 0.15 * person.manner.grip_tilt + drift(times, random, 0.04, 2.5)
    yaw = 0.20 + max(person.girth - 1.0, 0.0) + drift(times, random, 0.04, 3.0)
    roll = 0.15 + 0.4 * person.manner.grip_turn + drift(times, random, 0.03, 2.0)
    rolled = FOOT_TO_THE_RIGHT @ rotation_about("y", roll)
    head_from_flute = rotation_about("yz", droop, yaw) @ rolled
    rotation = trunk.world_from_head.rotation @ head_from_flute
    lips = Transform(mouth(person, trunk), trunk.world_from_head.rotation)
    hole = lips.apply(np.array([0.0, 0.012, -0.004]))
    return Transform(hole - rotation @ np.array([0.0, EMBOUCHURE, TUBE_RADIUS]), rotation)
