"""How an arm reaches: the shoulder glides, the elbow finds its easiest place, the wrist gives way.

Everything is a right arm's over T frames; a left one is reached with as its mirror image.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import (
    Transform,
    normalised,
    rotation_about,
    rotation_from_vector,
    turn_points,
)
from inhand_lab.people.parameters import (
    DEFAULT_LIMITS,
    USUAL_COMFORT,
    VARIED_COMFORT,
    ArmComfort,
)
from inhand_lab.people.person import Proportions, SimulatedPerson
from inhand_lab.people.solids import belly, rib_cage
from inhand_lab.people.two_bones import JointCircle, bend_towards, span

LEAST_SINE = 0.2
"""Sine of the angle between collar bone and arm below which turning the bone hardly helps."""
UPPER_ARM = ((0.35, 0.0275), (0.6, 0.0265), (0.9, 0.0254))
"""Places along the upper arm that press into the trunk, and its radii there in statures."""


@dataclass(frozen=True)
class ArmReach:
    """An arm whose elbow is still to be found: it is on a circle between shoulder and wrist.

    ``shoulder`` and ``wrist`` are (T, 3); ``from_chest`` and ``hand`` are world_from_part.
    """

    person: SimulatedPerson
    from_chest: Transform
    shoulder: Array
    wrist: Array
    circle: JointCircle
    hand: Transform


def reach_with_arm(
    person: SimulatedPerson, from_chest: Transform, shoulder: Array, hand: Transform
) -> tuple[list[Array], Transform]:
    """Shoulder, elbow, wrist and hand (T, 3) of a right arm, and the hand as it was reached."""
    body = person.proportions
    wanted = hand.translation - hand.rotation[:, :, 1] * body.palm
    shoulder = _protract(body, from_chest, shoulder, wanted)
    if person.varied:
        shoulder = _follow(body, from_chest, shoulder, wanted)
    bones = body.upper_arm, body.forearm
    circle, wrist = bend_towards(shoulder, wanted, bones, DEFAULT_LIMITS.elbow_extension)
    elbow = choose_elbow(
        ArmReach(person, from_chest, shoulder, wrist, circle, hand),
        VARIED_COMFORT if person.varied else USUAL_COMFORT,
    )
    rotation = _relieve_wrist(normalised(wrist - elbow), hand.rotation)
    reached = Transform(wrist + rotation[:, :, 1] * body.palm, rotation)
    return [shoulder, elbow, wrist, reached.translation], reached


def _protract(body: Proportions, from_chest: Transform, shoulder: Array, wrist: Array) -> Array:
    """A right shoulder (T, 3) that glides forward round the chest as the wrist goes across it."""
    to_chest = from_chest.inverse()
    local = to_chest.apply(shoulder)
    way = (local - to_chest.apply(wrist))[:, 0] / (body.upper_arm + body.forearm)
    share = np.clip(way, 0.0, 1.0)
    across = share**2 * (3.0 - 2.0 * share)
    turned = rotation_about("z", DEFAULT_LIMITS.protraction * across)
    return from_chest.apply(np.einsum("tij,tj->ti", turned, local))


def _follow(body: Proportions, from_chest: Transform, shoulder: Array, wrist: Array) -> Array:
    """A shoulder (T, 3) that goes with a wrist beyond the arm's easy reach, or back from one too
    near, as far as a collar bone turns."""
    angles = DEFAULT_LIMITS.flexion, VARIED_COMFORT.extension
    nearest, furthest = (span(body.upper_arm, body.forearm, angle) for angle in angles)
    bone, way = shoulder - from_chest.translation, wrist - shoulder
    length, distance = (np.linalg.norm(one, axis=1, keepdims=True) for one in (bone, way))
    axis = np.cross(bone, way) / (length * distance)
    sine = np.maximum(np.linalg.norm(axis, axis=1, keepdims=True), LEAST_SINE)
    lacking = distance - np.clip(distance, nearest, furthest)
    most = DEFAULT_LIMITS.follow
    turn = np.clip(lacking / (length * sine), -most, most)
    return from_chest.translation + turn_points(bone, axis / sine * turn)


def choose_elbow(reach: ArmReach, comfort: ArmComfort = USUAL_COMFORT) -> Array:
    """The elbow (T, 3) on its circle that is most comfortable: softly the cheapest swivel."""
    aside, circle = reach.from_chest.rotation[:, :, 0], reach.circle
    outward = normalised(aside - circle.axis * np.sum(aside * circle.axis, axis=1, keepdims=True))
    down = np.cross(circle.axis, outward)
    swivels = np.linspace(comfort.lowest_swivel, comfort.highest_swivel, comfort.swivels)
    across = (
        np.cos(swivels)[None, :, None] * down[:, None]
        + np.sin(swivels)[None, :, None] * outward[:, None]
    )
    elbows = circle.centre[:, None] + circle.radius[:, None, None] * across
    bend, twist = _wrist_angles(reach, elbows)
    cost = (
        _squeeze(reach, elbows, comfort)
        + ((swivels - reach.person.manner.elbow_flare) / comfort.swivel) ** 2
        + (bend / comfort.bend) ** 2
        + (np.clip(bend - DEFAULT_LIMITS.wrist_bend, 0.0, None) / comfort.strained) ** 2
        + (twist / comfort.twist) ** 2
        + (_pressed(reach, elbows, comfort) / comfort.pressed) ** 2
    )
    ease = np.exp(cost.min(axis=1, keepdims=True) - cost)
    swivel = (ease @ swivels) / ease.sum(axis=1)
    chosen = np.cos(swivel)[:, None] * down + np.sin(swivel)[:, None] * outward
    return np.asarray(circle.centre + circle.radius[:, None] * chosen)


def _wrist_angles(reach: ArmReach, elbows: Array) -> tuple[Array, Array]:
    """Bend and twist (T, K) of the wrist, radians, with elbows (T, K, 3)."""
    forearms = normalised(reach.wrist[:, None] - elbows)
    upwards = normalised(reach.shoulder[:, None] - elbows)
    neutral_thumb = normalised(
        upwards - forearms * np.sum(upwards * forearms, axis=2, keepdims=True)
    )
    fingers, thumb = reach.hand.rotation[:, :, 1], reach.hand.rotation[:, :, 2]
    bend = np.arccos(np.clip(_dots(forearms, fingers), -1.0, 1.0))
    twist = np.arccos(np.clip(_dots(neutral_thumb, thumb), -1.0, 1.0))
    return bend, twist


def _pressed(reach: ArmReach, elbows: Array, comfort: ArmComfort) -> Array:
    """Depths (T, K) to which elbows (T, K, 3) press into the side of the chest, metres."""
    person, from_chest = reach.person, reach.from_chest
    offset = elbows - from_chest.translation[:, None]
    sideways = _dots(offset, from_chest.rotation[:, :, 0])
    ahead = _dots(offset, from_chest.rotation[:, :, 1])
    stout = comfort.stout_elbows * person.height * max(person.girth - 1.0, 0.0)
    sides = person.proportions.shoulder_half_width + comfort.elbow_gap + stout
    chest_edge = sides - np.clip(ahead - comfort.chest_depth - stout, 0.0, None)
    return np.clip(chest_edge - sideways, 0.0, None)


def _squeeze(reach: ArmReach, elbows: Array, comfort: ArmComfort) -> Array:
    """Cost (T, K) of elbows (T, K, 3) whose arms press into ribs or belly."""
    person, from_chest = reach.person, reach.from_chest
    cost = np.zeros(elbows.shape[:2])
    for start, end, places in (
        (reach.shoulder[:, None], elbows, UPPER_ARM),
        (elbows, reach.wrist[:, None], comfort.forearm),
    ):
        for share, thickness in places:
            offset = start + share * (end - start) - from_chest.translation[:, None]
            local = np.einsum("tji,tkj->tki", from_chest.rotation, offset)
            for centre, radii in (rib_cage(person), belly(person)):
                around = radii + thickness * person.height * person.girth
                level = np.linalg.norm((local - centre) / around, axis=2)
                cost += (np.clip(1.0 - level, 0.0, None) / comfort.squeeze) ** 2
    return cost


def _relieve_wrist(forearm: Array, rotation: Array) -> Array:
    """The hand's rotation (T, 3, 3), turned back as far as it bends the wrist beyond its limit."""
    fingers = rotation[:, :, 1]
    hinge = np.cross(fingers, forearm)
    sine = np.linalg.norm(hinge, axis=1)
    bend = np.arctan2(sine, np.sum(fingers * forearm, axis=1))
    excess = np.clip(bend - DEFAULT_LIMITS.wrist_bend, 0.0, None) / np.maximum(sine, 1e-9)
    return np.asarray(rotation_from_vector(hinge * excess[:, None]) @ rotation)


def _dots(vectors: Array, against: Array) -> Array:
    """Scalar products (T, K) of vectors (T, K, 3) with one vector (T, 3) a frame."""
    return np.asarray(np.einsum("tkj,tj->tk", vectors, against))
