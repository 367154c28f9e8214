"""How somebody holds or wears an object, put into the hands of another body.

The hold is that of the same person in the simulated interaction: what usually carries the object,
the grip (grips.py), and how the wrist is turned from where the skeleton shows it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Literal

import numpy as np
from inhand_tracker.geometry.arrays import Array, Bytes

from inhand_lab.driven.parameters import DEFAULT_HOLD
from inhand_lab.driven.seen_frames import SeenFrames, seen_frames
from inhand_lab.geometry.transforms import Transform, mean_rotation, rotation_about
from inhand_lab.motions.grips import DRIFT_PERIOD, SLIDE_DRIFT, TURN_DRIFT
from inhand_lab.motions.performance import ContactKind
from inhand_lab.motions.timeline import drift
from inhand_lab.people.body_motion import BodyMotion
from inhand_lab.people.kinematics import place_body
from inhand_lab.people.person import SimulatedPerson
from inhand_lab.world.interactions import INTERACTIONS

Carrier = Literal["right_hand", "left_hand", "head", "right_foot", "left_foot"]

REHEARSAL_RATE = 30.0
"""Frames a second of the performance that shows the hold."""
REHEARSAL = np.arange(360) / REHEARSAL_RATE
"""Times of that performance, seconds."""


@dataclass(frozen=True)
class Hold:
    """A right-handed person's hold of an object.

    ``carrier_from_object`` is steady. ``right_wrist`` and ``left_wrist`` (3, 3) turn the hand that
    a skeleton shows into the one that holds. ``between_palms`` (3,) leads from the carrier's palm
    to the other one in the object's frame, where both hold it.
    """

    contact: ContactKind
    carrier: Carrier
    carrier_from_object: Transform
    right_wrist: Array
    left_wrist: Array
    between_palms: Array | None


@cache
def rehearse(interaction: str, person: SimulatedPerson, seed: int) -> Hold:
    """The person's hold in that interaction."""
    random = np.random.default_rng([seed, 0x401D])
    done = INTERACTIONS[interaction].perform(person, REHEARSAL, random)
    body = place_body(person, done.posture, done.right_hand, done.left_hand)
    contact = _usual(done.contact)
    held = done.contact == contact
    seen, world_from_object = seen_frames(body.joints, REHEARSAL_RATE), done.world_from_object
    carriers = _carriers(body, seen)
    steadiness = {
        carrier: _unsteadiness(carriers[carrier][held], world_from_object[held])
        for carrier in _possible(contact)
    }
    carrier = min(steadiness, key=lambda name: steadiness[name])
    between_palms = None
    if contact == ContactKind.BOTH_HANDS:
        way = body.from_left_hand.translation - body.from_right_hand.translation
        turned = np.einsum("tji,tj->ti", world_from_object.rotation, way)
        between_palms = turned[held].mean(axis=0)
    return Hold(
        contact,
        carrier,
        _mean(carriers[carrier][held].inverse() @ world_from_object[held]),
        _mean((seen.right_hand.inverse() @ body.from_right_hand)[held]).rotation,
        _mean((seen.left_hand.inverse() @ body.from_left_hand)[held]).rotation,
        between_palms,
    )


def attach(
    hold: Hold, body: BodyMotion, seen: SeenFrames, times: Array, random: np.random.Generator
) -> Transform:
    """The object in the hands of a body whose wrists are turned as the hold's, world_from_object.

    The grip drifts slowly. Where both hands hold, the carrier's grip stays and the object turns in
    it towards the other palm, the more surely the further that is; the other hand may slide.
    """
    grip = hold.carrier_from_object.repeated(len(times))
    if hold.contact != ContactKind.WORN:
        grip = _drifting(grip, times, random)
    placed = _carriers(body, seen)[hold.carrier] @ grip
    if hold.between_palms is None:
        return placed
    way = body.from_left_hand.translation - body.from_right_hand.translation
    square = np.sum(way**2, axis=1, keepdims=True)
    surely = way * square / (square + DEFAULT_HOLD.unsure**2)
    pull = surely[:, :, None] * (hold.between_palms / DEFAULT_HOLD.lever**2)
    rotation = _nearest_rotation(placed.rotation + pull)
    palm_in_object = grip.inverse().translation
    palm = body.from_right_hand.translation
    return Transform(palm - np.einsum("tij,tj->ti", rotation, palm_in_object), rotation)


def _carriers(body: BodyMotion, seen: SeenFrames) -> dict[Carrier, Transform]:
    return {
        "right_hand": body.from_right_hand,
        "left_hand": body.from_left_hand,
        "head": body.from_head,
        "right_foot": seen.right_foot,
        "left_foot": seen.left_foot,
    }


def _possible(contact: ContactKind) -> tuple[Carrier, ...]:
    if contact == ContactKind.WORN:
        return "head", "right_foot", "left_foot"
    return ("left_hand",) if contact == ContactKind.LEFT_HAND else ("right_hand",)


def _usual(contact: Bytes) -> ContactKind:
    """What an object is for: worn if it ever is, or else what holds it longest."""
    counts = np.bincount(contact, minlength=len(ContactKind))
    if counts[ContactKind.WORN]:
        return ContactKind.WORN
    counts[ContactKind.RESTING] = 0
    return ContactKind(int(counts.argmax()))


def _unsteadiness(world_from_carrier: Transform, world_from_object: Transform) -> float:
    """Deviation of the object's place in the carrier's frame, metres."""
    places = (world_from_carrier.inverse() @ world_from_object).translation
    return float(np.linalg.norm(places.std(axis=0)))


def _mean(transforms: Transform) -> Transform:
    return Transform(transforms.translation.mean(axis=0), mean_rotation(transforms.rotation))


def _drifting(grip: Transform, times: Array, random: np.random.Generator) -> Transform:
    turns = [drift(times, random, TURN_DRIFT, DRIFT_PERIOD) for _ in range(3)]
    slides = [drift(times, random, SLIDE_DRIFT, DRIFT_PERIOD) for _ in range(3)]
    return Transform(np.stack(slides, axis=1), rotation_about("xyz", *turns)) @ grip


def _nearest_rotation(matrices: Array) -> Array:
    """The rotations (T, 3, 3) that are nearest to matrices (T, 3, 3)."""
    left, _, right = np.linalg.svd(matrices)
    left[:, :, 2] *= np.linalg.det(left @ right)[:, None]
    return np.asarray(left @ right)
