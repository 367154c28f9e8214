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
from inhand_lab.motions.timeline import Key, Move, Pause, Stage, move_through, schedule, track
from inhand_lab.objects.glasses import EAR_DROP, TEMPLE_OFFSET
from inhand_lab.people.kinematics import Trunk, place_trunk
from inhand_lab.people.person import SimulatedPerson

OPENING = (
    Pause("wait", 0.4),
    Move("reach", 0.9),
    Move("grasp", 0.25),
    Move("fetch", 1.0),
)
USE = (
    Pause("inspect", 0.5),
    Move("put on", 1.3),
    Move("let go", 0.8),
    Pause("wear", 1.4),
    Move("take hold", 0.8),
    Move("take off", 1.1),
)
CLOSING = (
    Pause("inspect", 0.4),
    Move("return", 1.0),
    Move("release", 0.25),
    Move("withdraw", 0.9),
    Pause("wait", 0.4),
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
    stages = schedule(person, random, float(times[-1]), OPENING, USE, CLOSING)
    posture = stand(person, times, random, _stance(times, random, stages))
    trunk = place_trunk(person, posture)
    table, spot = _table(person, random)
    carried = _carry(person, times, random, trunk, spot, stages)
    right_held = carried @ _grip(person, times, random, stages)
    left_held = carried @ _grip(person, times, random, stages).mirrored()
    right_rest, left_rest = hanging_hands(person, trunk, random)
    upright = Transform(
        trunk.world_from_chest.translation, rotation_about("z", heading_of(trunk.world_from_chest))
    )
    return Performance(
        posture,
        move_through(times, _right_keys(stages, right_rest, right_held, upright @ RAISED)),
        move_through(times, _left_keys(stages, left_rest, left_held, upright @ RAISED.mirrored())),
        carried,
        contacts(times, _changes(stages)),
        table,
    )


def _right_keys(
    stages: list[Stage], rest: Transform, held: Transform, raised: Transform
) -> list[Key]:
    """The right hand fetches the glasses and returns them."""
    keys = []
    for stage in stages:
        if stage.name == "reach":
            keys += [Key(stage.start, rest), Key(stage.end, held, bow=(0.0, -0.06, 0.12))]
        if stage.name == "let go":
            keys += [Key(stage.start, held), Key(stage.end, rest, by=raised)]
        if stage.name == "take hold":
            keys += [Key(stage.start, rest), Key(stage.end, held, by=raised)]
        if stage.name == "withdraw":
            keys += [Key(stage.start, held), Key(stage.end, rest, bow=(0.0, -0.12, 0.12))]
    return keys


def _left_keys(
    stages: list[Stage], rest: Transform, held: Transform, raised: Transform
) -> list[Key]:
    """The left hand joins before the chest and helps at the face."""
    keys = []
    for stage in stages:
        if stage.name == "fetch":
            late = stage.start + 0.25 * (stage.end - stage.start)
            keys += [Key(late, rest), Key(stage.end, held, bow=(-0.05, 0.05, 0.0))]
        if stage.name == "let go":
            keys += [Key(stage.start, held), Key(stage.end, rest, by=raised)]
        if stage.name == "take hold":
            keys += [Key(stage.start, rest), Key(stage.end, held, by=raised)]
        if stage.name == "return":
            keys += [Key(stage.start, held), Key(stage.end, rest, bow=(-0.05, 0.05, 0.0))]
    return keys


def _changes(stages: list[Stage]) -> list[tuple[float, ContactKind]]:
    """When the glasses pass from the table to a hand, to both, to the head, and back."""
    changes = [(0.0, ContactKind.RESTING)]
    for stage in stages:
        if stage.name == "grasp":
            changes.append((stage.end, ContactKind.RIGHT_HAND))
        if stage.name in ("fetch", "take hold"):
            changes.append((stage.end, ContactKind.BOTH_HANDS))
        if stage.name == "let go":
            changes.append((stage.start, ContactKind.WORN))
        if stage.name == "return":
            changes.append((stage.start, ContactKind.RIGHT_HAND))
        if stage.name == "release":
            changes.append((stage.start, ContactKind.RESTING))
    return changes


def _stance(times: Array, random: np.random.Generator, stages: list[Stage]) -> Stance:
    """A look at the table and at the glasses; a look about while wearing them."""
    count = len(times)
    trunk, head = np.zeros((count, 3)), np.zeros((count, 3))
    for stage in stages:
        before, after = stage.start - 0.5, stage.end + 0.5
        keys = [(before, 0.0), (stage.start, 1.0), (stage.end, 1.0), (after, 0.0)]
        if stage.name in ("reach", "return"):
            keys = [(stage.start, 0.0), (stage.end, 1.0), (stage.end + 1.2, 0.0)]
            looked = track(times, keys)[:, None]
            head += looked * np.array([-0.30, 0.0, -0.35])
            trunk += looked * np.array([0.10, 0.03, -0.15])
        if stage.name == "inspect":
            head[:, 0] -= 0.35 * track(times, keys)
        if stage.name == "wear":
            aside, up = random.uniform(0.15, 0.45) * random.choice([-1.0, 1.0]), random.normal() / 9
            third = (stage.end - stage.start) / 3.0
            turns = [(0.0, 0.0), (third, 1.0), (2.0 * third, -0.7), (3.0 * third, 0.0)]
            about = track(times, [(stage.start + time, turn) for time, turn in turns])
            head += about[:, None] * np.array([up, 0.0, aside])
    right_foot, left_foot = feet_apart(count)
    return Stance(right_foot, left_foot, np.zeros(count), np.zeros((count, 3)), trunk, head)


def _table(person: SimulatedPerson, random: np.random.Generator) -> tuple[Furniture, Array]:
    """A small table at the right hand, and where the glasses' bridge is as they lie on it (3,)."""
    size = person.height / 1.75
    x, y = np.array([0.24, 0.37]) * size + random.normal(0.0, 0.015, 2)
    top = 0.53 * person.height + random.normal(0.0, 0.015)
    return side_table(x + 0.15, y + 0.09, top), np.array([x, y, top + EAR_DROP + 0.004])


def _grip(
    person: SimulatedPerson, times: Array, random: np.random.Generator, stages: list[Stage]
) -> Transform:
    """Thumb and fingers at a hinge, object_from_hand (T); they are shifted on the way to the face.

    Between the table and the face the hand turns about the pinched temple.
    """
    back = 0.022 + 0.012 * person.manner.grip_slide
    point = np.array([TEMPLE_OFFSET, -back, 0.006])
    turn = rotation_about("y", 0.6 * person.manner.grip_turn)
    at_table = pinch(times, random, point, turn @ TABLE_GRIP)
    at_face = pinch(times, random, point, turn @ FACE_GRIP)
    between = interpolate(at_table, at_face, np.full(len(times), 0.5))
    keys = [Key(0.0, at_table)]
    for stage in stages:
        if stage.name in ("fetch", "put on", "take off", "return"):
            goal = {"put on": at_face, "return": at_table}.get(stage.name, between)
            keys += [Key(stage.start, keys[-1].pose), Key(stage.end, goal)]
    return move_through(times, keys)


def _carry(
    person: SimulatedPerson,
    times: Array,
    random: np.random.Generator,
    trunk: Trunk,
    spot: Array,
    stages: list[Stage],
) -> Transform:
    """The glasses' way, world_from_object (T)."""
    body = person.proportions
    on_table = Transform(spot, rotation_about("z", random.normal(0.1, 0.15))).repeated(len(times))
    slipped = rotation_about("x", random.normal(-0.05, 0.03))
    bridge = np.array([0.0, body.head_half_depth + 0.012, 0.12 * body.head_half_height])
    worn = trunk.world_from_head @ Transform(bridge, slipped)
    before_face = trunk.world_from_head @ Transform(
        bridge + np.array([0.0, 0.14, 0.01]), rotation_about("x", -0.1)
    )
    upright = rotation_about("z", heading_of(trunk.world_from_chest))

    def before_chest() -> Transform:
        offset = np.array([0.0, 0.36, -0.16 * person.manner.amplitude])
        place = upright @ (offset + random.normal(0.0, 0.02, 3))
        tipped = rotation_about("xz", -0.45 + random.normal(0.0, 0.1), random.normal(0.0, 0.1))
        return Transform(trunk.world_from_chest.translation + place, upright @ tipped)

    keys = [Key(0.0, on_table)]
    for stage in stages:
        near = stage.start + 0.6 * (stage.end - stage.start)
        far = stage.start + 0.4 * (stage.end - stage.start)
        here = Key(stage.start, keys[-1].pose)
        if stage.name == "fetch":
            keys += [here, Key(stage.end, before_chest(), bow=(0.0, 0.0, 0.05))]
        if stage.name == "put on":
            keys += [here, Key(near, before_face, bow=(0.0, 0.03, 0.0)), Key(stage.end, worn)]
        if stage.name == "take off":
            keys += [here, Key(far, before_face), Key(stage.end, before_chest())]
        if stage.name == "return":
            keys += [here, Key(stage.end, on_table, bow=(0.0, 0.0, 0.05))]
    return move_through(times, keys)
