"""What an interaction hands to the world, and how people stand while they perform it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import IntEnum

import numpy as np
from inhand_tracker.geometry.arrays import Array, Bytes

from inhand_lab.geometry.transforms import (
    MIRROR,
    Transform,
    normalised,
    rotation_about,
    rotation_from_axes,
)
from inhand_lab.motions.furniture import WOOD, Cuboid, Furniture
from inhand_lab.motions.parameters import DEFAULT_VARIETY
from inhand_lab.motions.timeline import Stage, drift, minimum_jerk
from inhand_lab.people.kinematics import Posture, Trunk
from inhand_lab.people.person import SimulatedPerson, hip_height


class ContactKind(IntEnum):
    """What carries the object."""

    RESTING = 0
    RIGHT_HAND = 1
    LEFT_HAND = 2
    BOTH_HANDS = 3
    WORN = 4


@dataclass(frozen=True)
class Performance:
    """An interaction as a right-handed person means to do it, over T frames.

    The hands are targets, world_from_hand; contact (T,) holds values of ContactKind. ``stages`` are
    what is done when.
    """

    posture: Posture
    right_hand: Transform
    left_hand: Transform
    world_from_object: Transform
    contact: Bytes
    furniture: Furniture
    stages: Sequence[Stage]


@dataclass(frozen=True)
class Stance:
    """Where the body is meant to be, before sway and habit.

    The feet (T, 3) are the soles under the ankles; heading (T,) is the body's turn to the left in
    radians; shift (T, 3) moves the hips from the middle of the feet, in metres; the angles (T, 3)
    are those of Posture. foot_turns (T, 2) are the right and the left foot's turns to the left,
    where they differ from the heading.
    """

    right_foot: Array
    left_foot: Array
    heading: Array
    shift: Array
    trunk_angles: Array
    head_angles: Array
    foot_turns: Array | None = None


STANCE_HALF_WIDTH = 0.09
LEAST_ASIDE = 0.12
"""Least slope of a hanging arm outwards, so that its hand is beside a hip that is shifted to it."""
EASY_KNEES = 0.985
"""Straightness of the legs in easy standing, as a share of their length."""
SEAT, SEAT_BACK = 0.30, -0.09
"""Breadth of a stool's seat, and its middle ahead of the hips, metres."""


def feet_apart(
    person: SimulatedPerson, count: int, half_width: float = STANCE_HALF_WIDTH
) -> tuple[Array, Array]:
    """Right and left soles (T, 3) on the floor, as far apart as the task and the person have it.

    ``half_width`` is the task's, in metres; people differ as much in wide stances as in others.
    """
    own = half_width + (person.carriage.stance_width - 1.0) * STANCE_HALF_WIDTH
    ahead = 0.5 * person.carriage.foot_ahead * person.height
    right = np.tile([own, ahead, 0.0], (count, 1))
    return right, -right


def step(times: Array, start: float, end: float, way: Array) -> Array:
    """One foot's displacement (T, 3) by a step of way (2,) metres over the floor."""
    share = minimum_jerk((times - start) / (end - start))
    lift = 0.6 * float(np.linalg.norm(way)) * 4.0 * share * (1.0 - share)
    return np.concatenate([share[:, None] * way, lift[:, None]], axis=1)


def contacts(times: Array, changes: list[tuple[float, ContactKind]]) -> Bytes:
    """What carries the object (T,): from each time, in order, on."""
    starts = [start for start, _ in changes]
    values = np.array([contact for _, contact in changes], np.uint8)
    return np.asarray(values[np.searchsorted(starts, times, side="right") - 1])


def stand(
    person: SimulatedPerson, times: Array, random: np.random.Generator, stance: Stance
) -> Posture:
    """A posture on those feet: hips within the legs' reach, with the person's stoop and sway.

    A lean is shared between hips and back, and the hips go back to keep the balance.
    """
    manner, body = person.manner, person.proportions
    sway = np.stack([drift(times, random, manner.sway, 4.0) for _ in range(2)], axis=1)
    wander = np.stack([drift(times, random, 0.02, 5.0) for _ in range(3)], axis=1)
    glances = np.stack([drift(times, random, 0.05, 3.0) for _ in range(3)], axis=1)
    trunk = stance.trunk_angles + wander + np.array([manner.stoop, 0.0, 0.0])
    head = stance.head_angles + glances
    head += np.array([manner.head_pitch, person.carriage.head_aside, 0.0])
    heading = rotation_about("z", stance.heading)
    hips = 0.5 * (stance.right_foot + stance.left_foot) + stance.shift
    hips[:, :2] += sway
    hips += heading[:, :, 0] * (person.carriage.weight_aside * person.height)
    hips -= heading[:, :, 1] * (0.30 * body.chest * np.sin(0.5 * trunk[:, :1]))
    hips[:, 2] = stance.shift[:, 2] + _hip_reach(person, hips, heading, stance) + body.hip_drop
    pelvis = heading @ rotation_about("xz", -0.5 * trunk[:, 0], 0.3 * trunk[:, 2])
    trunk = trunk * np.array([0.5, 1.0, 0.7])
    feet = stance.heading[:, None] if stance.foot_turns is None else stance.foot_turns
    return Posture(
        Transform(hips, pelvis),
        trunk,
        head,
        Transform(stance.right_foot, rotation_about("z", feet[:, 0] - person.carriage.toes_out)),
        Transform(stance.left_foot, rotation_about("z", feet[:, -1] + person.carriage.toes_out)),
    )


def sit(person: SimulatedPerson, stance: Stance) -> Stance:
    """The stance on a bar stool: the hips lower where they were, the feet on the floor ahead."""
    ahead, drop = DEFAULT_VARIETY.feet_ahead * person.height, DEFAULT_VARIETY.seat_drop
    legs = _easy_legs(person)
    lowered = legs - float(np.sqrt(legs**2 - ahead**2))
    forward = np.array([0.0, ahead, 0.0])
    return replace(
        stance,
        right_foot=stance.right_foot + forward,
        left_foot=stance.left_foot + forward,
        shift=stance.shift - forward - [0.0, 0.0, drop * person.height - lowered],
    )


def stool(person: SimulatedPerson) -> Furniture:
    """The bar stool of who sits: seat, leg and foot, metres."""
    hips = person.proportions.ankle + _easy_legs(person) - DEFAULT_VARIETY.seat_drop * person.height
    top = hips - 0.05 * person.height * person.girth - 0.02
    return (
        Cuboid((0.0, SEAT_BACK, top - 0.02), (SEAT, SEAT, 0.04), WOOD),
        Cuboid((0.0, SEAT_BACK, 0.5 * top), (0.05, 0.05, top - 0.06), WOOD),
        Cuboid((0.0, SEAT_BACK, 0.015), (0.36, 0.36, 0.03), WOOD),
    )


def _easy_legs(person: SimulatedPerson) -> float:
    """Distance of hip joint and ankle in easy standing, metres."""
    return EASY_KNEES * (hip_height(person.proportions) - person.proportions.ankle)


def _hip_reach(person: SimulatedPerson, hips: Array, heading: Array, stance: Stance) -> Array:
    """Height (T,) of the hip joints above the floor at which the first leg is nearly straight."""
    body = person.proportions
    length = _easy_legs(person)
    aside = heading[:, :, 0] * body.hip_half_width
    heights = []
    for side, foot in ((1.0, stance.right_foot), (-1.0, stance.left_foot)):
        span = np.linalg.norm((hips + side * aside - foot)[:, :2], axis=1)
        heights.append(foot[:, 2] + np.sqrt(length**2 - span**2))
    return np.asarray(body.ankle + np.minimum(*heights))


def hanging_hands(
    person: SimulatedPerson, trunk: Trunk, random: np.random.Generator
) -> tuple[Transform, Transform]:
    """The right and the left hand (T) hanging at ease beside the thighs."""
    heading = heading_of(trunk.world_from_chest)
    right = _hang(person, trunk.right_shoulder, heading, random)
    left = _hang(person, trunk.left_shoulder * MIRROR, -heading, random)
    return right, left.mirrored()


def _hang(
    person: SimulatedPerson, shoulder: Array, heading: Array, random: np.random.Generator
) -> Transform:
    body = person.proportions
    reach = 0.965 * (body.upper_arm + body.forearm) + body.palm
    ahead, aside = random.normal(0.10, 0.03), random.normal(0.12, 0.02)
    if person.varied:
        aside = max(aside, LEAST_ASIDE) * max(person.girth, 1.0)
    downwards = normalised([aside, ahead, -1.0])
    hand = rotation_from_axes([-0.05, 0.15 + ahead, -1.0], [-0.35, 1.0, 0.0])
    upright = rotation_about("z", heading)
    return Transform(shoulder + upright @ (downwards * reach), upright @ hand)


def heading_of(frame: Transform) -> Array:
    """Turn (T,) to the left of a frame's y axis, radians."""
    forward = frame.rotation[:, :, 1]
    return np.asarray(np.arctan2(-forward[:, 0], forward[:, 1]))


def upright(frame: Transform) -> Transform:
    """A frame (T) turned to the left as it is, but not leaning."""
    return Transform(frame.translation, rotation_about("z", heading_of(frame)))


def mouth(person: SimulatedPerson, trunk: Trunk) -> Array:
    """The lips (T, 3) in the world."""
    body = person.proportions
    point = np.array([0.0, 0.93 * body.head_half_depth, -0.54 * body.head_half_height])
    return trunk.world_from_head.apply(point)
