"""answerPhone: take a phone from its dock, talk, look at it or change ears, put it back."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import Transform, normalised, rotation_about, rotation_from_axes
from inhand_lab.motions.furniture import Cuboid, Furniture, side_table
from inhand_lab.motions.grips import DRIFT_PERIOD, SLIDE_DRIFT, TURN_DRIFT
from inhand_lab.motions.performance import ContactKind, Performance, Stance, hanging_hands, upright
from inhand_lab.motions.reaching import PUT_BACK, TAKE, attention, carried_by
from inhand_lab.motions.script import Script, To, write_script
from inhand_lab.motions.timeline import Key, Move, Pause, Plan, Stage, move_through
from inhand_lab.objects.phone import PHONE_LENGTH, PHONE_THICKNESS
from inhand_lab.people.kinematics import Trunk
from inhand_lab.people.person import SimulatedPerson
from inhand_lab.people.solids import head_radii

PLAN = Plan(
    opening=(*TAKE, Move("fetch", 0.9), Pause("read", 0.6)),
    use=(Move("raise", 0.9), Pause("talk", 2.0), Move("lower", 0.9), Move("look", 0.8)),
    closing=PUT_BACK,
    on_stool=True,
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
EAR_UP, EARPIECE_GAP = 0.022, 0.004
"""The touching point above the phone's middle, and the phone off the head, metres."""
BESIDE_EAR = Transform(np.array([0.11, 0.09, -0.07]), np.eye(3))
"""Where the phone passes on its way to the right ear, from its place on it, in the head's frame."""
AROUND_TABLE = (0.04, -0.12, 0.14)
"""How the right hand's way to the dock and back swings out, metres."""

DOCK_SIZE = (0.070, 0.070, 0.025)
DOCK_COLOUR = (58, 58, 62)
PLUGGED = 0.006
"""How deep the phone stands in its dock."""


@dataclass(frozen=True)
class HandChange:
    """A look at the phone during which it passes to a hand: 1 the right one, -1 the left one.

    In the look's middle third both hands hold it.
    """

    look: Stage
    taker: float

    @property
    def taken(self) -> float:
        """When the other hand has taken hold, seconds."""
        return self.look.at(1.0 / 3.0)

    @property
    def left(self) -> float:
        """When the hand that held it lets go, seconds."""
        return self.look.at(2.0 / 3.0)


def perform(person: SimulatedPerson, times: Array, random: np.random.Generator) -> Performance:
    """Answering a phone at these times, in seconds from the start."""
    script = write_script(person, times, random, PLAN)
    sides = _sides(script)
    changes = _changes(script, sides)
    posture, trunk = script.stand(_stance(script, sides))
    furniture, docked = _dock(script)
    carried = _carry(script, trunk, script.still(docked), sides)
    apart, slant = APART * _changing(script, changes), _slant(script)
    right_held = carried @ _grip(script, slant, -apart)
    left_held = carried @ _grip(script, slant, apart).mirrored()
    right_rest, left_rest = hanging_hands(person, trunk, random)
    right_hand = _right_hand(script, changes, right_rest, right_held)
    left_keys = [Key(0.0, left_rest), *_pass(changes, left_rest, left_held, side=-1)]
    left_hand = move_through(script.times, left_keys)
    contact = carried_by(script, *_contacts(changes))
    return Performance(posture, right_hand, left_hand, carried, contact, furniture, script.stages)


def _sides(script: Script) -> list[float]:
    """The hand and ear of every call, 1 right and -1 left, and the right hand to put it back."""
    others = script.random.random(len(script.every("talk")) - 1)
    return [1.0, *(float(side) for side in np.where(others < CHANGE_SHARE, -1.0, 1.0)), 1.0]


def _changes(script: Script, sides: list[float]) -> list[HandChange]:
    """The looks at which the phone changes hands."""
    return [
        HandChange(look, after)
        for look, (before, after) in zip(script.every("look"), pairwise(sides), strict=True)
        if before != after
    ]


def _stance(script: Script, sides: list[float]) -> Stance:
    """A look at the dock and at the screen; small movements of the head in talking."""
    looked, random = attention(script), script.random
    trunk, head = np.outer(looked, [0.10, 0.03, -0.15]), np.outer(looked, [-0.28, 0.0, -0.35])
    nods = np.stack([script.drift(size, 1.1) for size in (0.07, 0.03, 0.07)], axis=1)
    for stage in script.every("read", "look", "talk"):
        there = script.around(stage, 0.5, 0.6)[:, None]
        if stage.name == "talk":
            towards_phone = np.array([0.0, sides[stage.repetition] * 0.02, 0.0])
            turned = np.array([0.0, 0.0, random.normal(0.0, 0.12)])
            head += there * (nods + towards_phone + turned)
            trunk += there * np.array([0.0, 0.0, random.normal(0.0, 0.10)])
        else:
            head += there * np.array([-0.30, 0.0, 0.0])
    return script.upright_stance(trunk, head)


def _dock(script: Script) -> tuple[Furniture, Transform]:
    """A table at the right hand with a dock on it, and the phone in the dock facing left."""
    x, y = script.place(0.31, 0.32)
    top = script.table_top(0.52)
    dock = Cuboid((x, y, top + DOCK_SIZE[2] / 2.0), DOCK_SIZE, DOCK_COLOUR)
    turn = script.random.normal(0.0, 0.10)
    screen = rotation_about("z", turn) @ np.array([-0.82, -0.55, 0.15])
    rotation = rotation_from_axes(screen, [0.0, 0.0, 1.0])
    foot = np.array([x, y, top + DOCK_SIZE[2] - PLUGGED])
    docked = Transform(foot + rotation[:, 2] * (PHONE_LENGTH / 2.0), rotation)
    return (*side_table(x + 0.10, y + 0.12, top), dock, *script.seat), docked


def _slant(script: Script) -> Array:
    """The turn (T,) of the fingers up the phone's back, radians."""
    dock, eyes, ear = SLANTS["dock"], SLANTS["eyes"], SLANTS["ear"]
    return script.level(dock, {"fetch": eyes, "raise": ear, "lower": eyes, "return": dock})


def _grip(script: Script, slant: Array, up: Array) -> Transform:
    """The phone in the fingers, its back to the palm, object_from_hand (T).

    slant (T,) turns the fingers up the phone, radians; up (T,) moves the hand up it, metres.
    """
    manner = script.person.manner
    wobble = rotation_about("xyz", *script.drifts(TURN_DRIFT, DRIFT_PERIOD).T)
    rotation = rotation_about("y", -slant - 0.25 * manner.grip_turn) @ FLAT @ wobble
    place = -rotation @ PHONE_IN_HAND
    place[:, 2] += up + 0.012 * manner.grip_slide + script.drift(SLIDE_DRIFT, DRIFT_PERIOD)
    return Transform(place, rotation)


def _carry(script: Script, trunk: Trunk, docked: Transform, sides: list[float]) -> Transform:
    """The phone's way, world_from_object (T): dock, before the eyes, ear and back."""
    random = script.random
    head_from_phone = _at_right_ear(script)
    chest = upright(trunk.world_from_chest)

    def on_side(side: float, on_right: Transform) -> Transform:
        return on_right if side > 0.0 else on_right.mirrored()

    def before_eyes(side: float) -> Transform:
        offset = np.array([0.06, 0.31, -0.07]) + random.normal(0.0, 0.02, 3)
        screen = [-0.10 + random.normal(0.0, 0.1), -0.80, 0.60]
        held = Transform(offset, rotation_from_axes(screen, [0.10, 0.0, 1.0]))
        return chest @ on_side(side, held)

    def at_ear(stage: Stage) -> Transform:
        return trunk.world_from_head @ on_side(sides[stage.repetition], head_from_phone)

    def beside_ear(stage: Stage) -> Transform:
        beside = BESIDE_EAR @ head_from_phone
        return trunk.world_from_head @ on_side(sides[stage.repetition], beside)

    def before_next_eyes(look: Stage) -> Transform | None:
        side, next_side = sides[look.repetition : look.repetition + 2]
        return before_eyes(next_side) if side != next_side else None

    goals = {
        "fetch": To(lambda _: before_eyes(1.0), bow=(0.0, 0.0, 0.04)),
        "raise": To(at_ear, by=beside_ear),
        "lower": To(lambda stage: before_eyes(sides[stage.repetition]), by=beside_ear),
        "look": To(before_next_eyes),
        "return": To(docked, bow=(0.0, 0.0, 0.05)),
    }
    return script.way(docked, goals)


def _at_right_ear(script: Script) -> Transform:
    """The phone flat on the head from the ear towards the mouth, head_from_object."""
    radii = head_radii(script.person)
    touched = radii * EAR
    outwards = normalised(touched / radii**2)
    slope = -0.85 + script.random.normal(0.0, 0.10)
    rotation = rotation_from_axes(-outwards, [0.0, slope, 0.75])
    gap = EARPIECE_GAP + PHONE_THICKNESS / 2.0
    return Transform(touched + gap * outwards - EAR_UP * rotation[:, 2], rotation)


def _changing(script: Script, changes: list[HandChange]) -> Array:
    """How far (T,), 0 to 1, hands make room for each other on the phone."""
    shares = [script.around(change.look, 0.8, 0.8) for change in changes]
    return np.sum([np.zeros(len(script.times)), *shares], axis=0)


def _right_hand(
    script: Script, changes: list[HandChange], rest: Transform, held: Transform
) -> Transform:
    """The right hand, world_from_hand (T), which fetches the phone and puts it back."""
    reach, withdraw = script.stage("reach"), script.stage("withdraw")
    keys = [
        Key(reach.start, rest),
        Key(reach.end, held, AROUND_TABLE),
        *_pass(changes, rest, held, side=1),
        Key(withdraw.start, held),
        Key(withdraw.end, rest, AROUND_TABLE),
    ]
    return move_through(script.times, keys)


def _pass(changes: list[HandChange], rest: Transform, held: Transform, side: int) -> list[Key]:
    """How a hand, 1 the right and -1 the left, takes the phone from the other or gives it away."""
    beside = Transform(held.translation + np.array([side * 0.26, 0.16, 0.0]), held.rotation)
    keys = []
    for change in changes:
        if change.taker == side:
            keys += [Key(change.look.start - 0.7, rest), Key(change.taken, held, by=beside)]
        else:
            drop = Key(change.look.end + LETTING_GO, rest, by=beside)
            keys += [Key(change.left, held), drop]
    return keys


def _contacts(changes: list[HandChange]) -> Iterator[tuple[float, ContactKind]]:
    """When the phone passes from a hand to both, and to the other."""
    for change in changes:
        yield change.taken, ContactKind.BOTH_HANDS
        yield change.left, ContactKind.RIGHT_HAND if change.taker > 0.0 else ContactKind.LEFT_HAND
