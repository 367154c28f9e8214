"""answerPhone: take a phone from its dock, talk, look at it or change ears, put it back."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import Transform, normalised, rotation_about, rotation_from_axes
from inhand_lab.motions.furniture import Cuboid, Furniture, side_table
from inhand_lab.motions.grips import DRIFT_PERIOD, SLIDE_DRIFT, TURN_DRIFT
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
from inhand_lab.motions.reaching import PUT_BACK, TAKE, attention, named
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
from inhand_lab.objects.phone import PHONE_LENGTH, PHONE_THICKNESS
from inhand_lab.people.kinematics import Trunk, place_trunk
from inhand_lab.people.person import SimulatedPerson
from inhand_lab.people.solids import head_radii

OPENING = (*TAKE, Move("fetch", 0.9), Pause("read", 0.6))
USE = (
    Move("raise", 0.9),
    Pause("talk", 2.0),
    Move("lower", 0.9),
    Move("look", 0.8),
)

CHANGE_SHARE = 0.5
"""How often somebody takes the phone into the other hand for the next call."""
LETTING_GO = 0.8
"""Time for the hand that gave the phone away to drop, seconds."""

FLAT = rotation_about("z", -0.5 * np.pi)
"""Object_from_hand with the thumb up the phone's side and the fingers across its back."""
SLANTS = {"dock": -0.05, "eyes": 0.75, "ear": 1.75}
"""Turn of the fingers up the phone's back from there, radians: the hand shifts its hold."""
PHONE_IN_HAND = np.array([-0.050, -0.004, 0.012])
"""The phone's middle in the hand's frame: in the fingers, before a hollow palm."""
APART = 0.055
"""Each of two hands from the phone's middle, up or down it."""

EAR = normalised([0.97, 0.20, -0.08])
"""Where the phone touches the head's right, in units of the head's radii."""
EAR_UP = 0.022
"""The touching point above the phone's middle."""
EARPIECE_GAP = 0.004

DOCK_SIZE = (0.070, 0.070, 0.025)
DOCK_COLOUR = (58, 58, 62)
PLUGGED = 0.006
"""How deep the phone stands in its dock."""


def perform(person: SimulatedPerson, times: Array, random: np.random.Generator) -> Performance:
    """Answering a phone at these times, in seconds from the start."""
    stages = schedule(person, random, float(times[-1]), OPENING, USE, PUT_BACK)
    sides = _sides(random, stages)
    posture = stand(person, times, random, _stance(times, random, stages, sides))
    trunk = place_trunk(person, posture)
    furniture, docked = _dock(person, random)
    carried = _carry(person, times, random, trunk, docked.repeated(len(times)), stages, sides)
    apart = APART * _changing(times, stages, sides)
    slant = _slant(times, stages)
    right_held = carried @ _grip(person, times, random, slant, -apart)
    left_held = carried @ _grip(person, times, random, slant, apart).mirrored()
    right_rest, left_rest = hanging_hands(person, trunk, random)
    right_keys = _hand_keys(stages, sides, right_rest, right_held, 1.0)
    left_keys = _hand_keys(stages, sides, left_rest, left_held, -1.0)
    return Performance(
        posture,
        move_through(times, right_keys),
        move_through(times, left_keys),
        carried,
        contacts(times, _contacts(stages, sides)),
        furniture,
    )


def _sides(random: np.random.Generator, stages: list[Stage]) -> list[float]:
    """The hand and ear of every call, 1 right and -1 left, and the right hand to put it back."""
    calls = sum(stage.name == "talk" for stage in stages)
    others = np.where(random.random(calls - 1) < CHANGE_SHARE, -1.0, 1.0)
    return [1.0, *(float(side) for side in others), 1.0]


def _changes(stages: list[Stage], sides: list[float]) -> list[tuple[Stage, float]]:
    """The looks at which the phone changes hands, and which hand takes it."""
    looks = [stage for stage in stages if stage.name == "look"]
    return [
        (stage, after)
        for stage, (before, after) in zip(looks, pairwise(sides), strict=True)
        if before != after
    ]


def _stance(
    times: Array, random: np.random.Generator, stages: list[Stage], sides: list[float]
) -> Stance:
    """A look at the dock and at the screen; small movements of the head in talking."""
    count = len(times)
    looked = attention(times, stages)[:, None]
    trunk = looked * np.array([0.10, 0.03, -0.15])
    head = looked * np.array([-0.28, 0.0, -0.35])
    nods = np.stack([drift(times, random, size, 1.1) for size in (0.07, 0.03, 0.07)], axis=1)
    for stage in stages:
        keys = [(stage.start - 0.5, 0.0), (stage.start, 1.0), (stage.end, 1.0)]
        there = track(times, [*keys, (stage.end + 0.6, 0.0)])[:, None]
        if stage.name in ("read", "look"):
            head += there * np.array([-0.30, 0.0, 0.0])
        if stage.name == "talk":
            towards_phone = np.array([0.0, sides[stage.repetition] * 0.02, 0.0])
            turned = np.array([0.0, 0.0, random.normal(0.0, 0.12)])
            head += there * (nods + towards_phone + turned)
            trunk += there * np.array([0.0, 0.0, random.normal(0.0, 0.10)])
    right_foot, left_foot = feet_apart(count)
    return Stance(right_foot, left_foot, np.zeros(count), np.zeros((count, 3)), trunk, head)


def _dock(person: SimulatedPerson, random: np.random.Generator) -> tuple[Furniture, Transform]:
    """A table at the right hand with a dock on it, and the phone in the dock facing left."""
    size = person.height / 1.75
    x, y = np.array([0.31, 0.32]) * size + random.normal(0.0, 0.015, 2)
    top = 0.52 * person.height + random.normal(0.0, 0.015)
    dock = Cuboid((x, y, top + DOCK_SIZE[2] / 2.0), DOCK_SIZE, DOCK_COLOUR)
    turn = random.normal(0.0, 0.10)
    screen = rotation_about("z", turn) @ np.array([-0.82, -0.55, 0.15])
    rotation = rotation_from_axes(screen, [0.0, 0.0, 1.0])
    foot = np.array([x, y, top + DOCK_SIZE[2] - PLUGGED])
    docked = Transform(foot + rotation[:, 2] * (PHONE_LENGTH / 2.0), rotation)
    return (*side_table(x + 0.10, y + 0.12, top), dock), docked


def _slant(times: Array, stages: list[Stage]) -> Array:
    """The turn (T,) of the fingers up the phone's back, radians."""
    ends = {"fetch": "eyes", "raise": "ear", "lower": "eyes", "return": "dock"}
    keys = [(0.0, SLANTS["dock"])]
    for stage in stages:
        if stage.name in ends:
            keys += [(stage.start, keys[-1][1]), (stage.end, SLANTS[ends[stage.name]])]
    return track(times, keys)


def _grip(
    person: SimulatedPerson, times: Array, random: np.random.Generator, slant: Array, up: Array
) -> Transform:
    """The phone in the fingers, its back to the palm, object_from_hand (T).

    slant (T,) turns the fingers up the phone, radians; up (T,) moves the hand up it, metres.
    """
    wobble = [drift(times, random, TURN_DRIFT, DRIFT_PERIOD) for _ in range(3)]
    turn = -slant - 0.25 * person.manner.grip_turn
    rotation = rotation_about("y", turn) @ FLAT @ rotation_about("xyz", *wobble)
    place = -rotation @ PHONE_IN_HAND
    place[:, 2] += up + 0.012 * person.manner.grip_slide
    place[:, 2] += drift(times, random, SLIDE_DRIFT, DRIFT_PERIOD)
    return Transform(place, rotation)


def _carry(
    person: SimulatedPerson,
    times: Array,
    random: np.random.Generator,
    trunk: Trunk,
    docked: Transform,
    stages: list[Stage],
    sides: list[float],
) -> Transform:
    """The phone's way, world_from_object (T): dock, before the eyes, ear and back."""
    head_from_phone = _at_right_ear(person, random)
    aside = Transform(np.array([0.11, 0.09, -0.07]), np.eye(3)) @ head_from_phone
    upright = Transform(
        trunk.world_from_chest.translation, rotation_about("z", heading_of(trunk.world_from_chest))
    )

    def held_before_eyes(side: float) -> Transform:
        offset = np.array([0.06, 0.31, -0.07]) + random.normal(0.0, 0.02, 3)
        screen = [-0.10 + random.normal(0.0, 0.1), -0.80, 0.60]
        held = Transform(offset, rotation_from_axes(screen, [0.10, 0.0, 1.0]))
        return upright @ (held if side > 0.0 else held.mirrored())

    def placed(by_right_ear: Transform, side: float) -> Transform:
        return trunk.world_from_head @ (by_right_ear if side > 0.0 else by_right_ear.mirrored())

    keys = [Key(0.0, docked)]
    for stage in stages:
        here = Key(stage.start, keys[-1].pose)
        side, next_side = sides[stage.repetition : stage.repetition + 2]
        if stage.name == "fetch":
            keys += [here, Key(stage.end, held_before_eyes(1.0), bow=(0.0, 0.0, 0.04))]
        if stage.name == "raise":
            at_ear = placed(head_from_phone, side)
            keys += [here, Key(stage.end, at_ear, by=placed(aside, side))]
        if stage.name == "lower":
            keys += [here, Key(stage.end, held_before_eyes(side), by=placed(aside, side))]
        if stage.name == "look" and side != next_side:
            keys += [here, Key(stage.end, held_before_eyes(next_side))]
        if stage.name == "return":
            keys += [here, Key(stage.end, docked, bow=(0.0, 0.0, 0.05))]
    return move_through(times, keys)


def _at_right_ear(person: SimulatedPerson, random: np.random.Generator) -> Transform:
    """The phone flat on the head from the ear towards the mouth, head_from_object."""
    radii = head_radii(person)
    touched = radii * EAR
    outwards = normalised(touched / radii**2)
    slope = -0.85 + random.normal(0.0, 0.10)
    rotation = rotation_from_axes(-outwards, [0.0, slope, 0.75])
    gap = EARPIECE_GAP + PHONE_THICKNESS / 2.0
    return Transform(touched + gap * outwards - EAR_UP * rotation[:, 2], rotation)


def _changing(times: Array, stages: list[Stage], sides: list[float]) -> Array:
    """How far (T,), 0 to 1, hands make room for each other on the phone."""
    share = np.zeros(len(times))
    for look, _ in _changes(stages, sides):
        keys = [(look.start - 0.8, 0.0), (look.start, 1.0), (look.end, 1.0), (look.end + 0.8, 0.0)]
        share += track(times, keys)
    return share


def _hand_keys(
    stages: list[Stage], sides: list[float], rest: Transform, held: Transform, side: float
) -> list[Key]:
    """The way of the right hand (side 1), which fetches the phone, or of the left (side -1)."""
    keys = [Key(0.0, rest)]
    beside = Transform(held.translation + np.array([side * 0.26, 0.16, 0.0]), held.rotation)
    if side > 0.0:
        reach = named(stages, "reach")
        keys += [Key(reach.start, rest), Key(reach.end, held, bow=(0.04, -0.12, 0.14))]
    for look, taker in _changes(stages, sides):
        third = (look.end - look.start) / 3.0
        if taker == side:
            keys += [Key(look.start - 0.7, rest), Key(look.start + third, held, by=beside)]
        else:
            keys += [Key(look.end - third, held), Key(look.end + LETTING_GO, rest, by=beside)]
    if side > 0.0:
        withdraw = named(stages, "withdraw")
        keys += [Key(withdraw.start, held), Key(withdraw.end, rest, bow=(0.04, -0.12, 0.14))]
    return keys


def _contacts(stages: list[Stage], sides: list[float]) -> list[tuple[float, ContactKind]]:
    """When the phone passes from its dock to a hand, to both, to the other, and back."""
    changes = [(0.0, ContactKind.RESTING), (named(stages, "grasp").end, ContactKind.RIGHT_HAND)]
    for look, taker in _changes(stages, sides):
        third = (look.end - look.start) / 3.0
        holder = ContactKind.RIGHT_HAND if taker > 0.0 else ContactKind.LEFT_HAND
        changes += [(look.start + third, ContactKind.BOTH_HANDS), (look.end - third, holder)]
    return [*changes, (named(stages, "release").start, ContactKind.RESTING)]
