"""From a posture and where the hands should be to twenty joints.

The person's world: origin on the floor between the feet, x to the person's right, y forward, z up.
A hand's frame: origin in the palm, y along the fingers, z towards the thumb; the palm faces -x on
the right hand and +x on the left, so that reflection in x = 0 exchanges the hands.
Everybody moves as a right-handed person here; the world mirrors left-handed people.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import (
    MIRROR,
    Transform,
    normalised,
    rotation_about,
    rotation_from_vector,
)
from inhand_lab.people.body_motion import BodyMotion
from inhand_lab.people.person import Proportions, SimulatedPerson
from inhand_lab.people.solids import belly, rib_cage

ELBOW_EXTENSION = np.radians(172.0)
KNEE_EXTENSION = np.radians(178.0)
FLEXION_LIMIT = np.radians(30.0)
WRIST_LIMIT = np.radians(75.0)
SWIVELS = np.linspace(-0.4, 1.7, 22)
STOUT_ELBOWS = 0.30
"""How much further from the trunk stout people carry their elbows, in statures a share of girth."""
UPPER_ARM = ((0.35, 0.0275), (0.6, 0.0265), (0.9, 0.0254))
"""Places along the upper arm that press into the trunk, and its radii there in statures."""
EASY_SQUEEZE = 0.015
"""How deep, as a share of the chest's radius, an arm is pressed to it with ease."""
PROTRACTION = np.radians(25.0)
"""How far a collar bone turns forward for an arm that reaches straight across the chest; it can by
15 to 30 degrees (Neumann, *Kinesiology of the Musculoskeletal System*)."""
BALL_HEIGHT = 0.02


@dataclass(frozen=True)
class Posture:
    """The body without its arms, over T frames.

    trunk_angles (T, 3): lean forward, lean to the right, twist to the left, radians, relative to
    the pelvis. head_angles (T, 3): pitch up, tilt to the right, turn to the left, relative to the
    chest. The feet's transforms have their origin on the sole under the ankle and y to the toes.
    """

    world_from_pelvis: Transform
    trunk_angles: Array
    head_angles: Array
    world_from_right_foot: Transform
    world_from_left_foot: Transform


@dataclass(frozen=True)
class Trunk:
    """Frames that hands can be placed by, over T frames: all upright in a straight stance.

    Origins: hip centre, shoulder centre, middle of the head. The shoulders are points (T, 3).
    """

    world_from_pelvis: Transform
    world_from_chest: Transform
    world_from_head: Transform
    right_shoulder: Array
    left_shoulder: Array
    spine: Array


@dataclass(frozen=True)
class Circle:
    """Where the middle joint of a two-bone limb may be: axis and centre (T, 3), radius (T,)."""

    axis: Array
    centre: Array
    radius: Array


def place_trunk(person: SimulatedPerson, posture: Posture) -> Trunk:
    """Forward kinematics from the pelvis to the head and shoulders."""
    body = person.proportions
    pelvis = posture.world_from_pelvis
    forward, right, left_twist = posture.trunk_angles.T
    pelvis_from_chest = rotation_about("yxz", right, -forward, left_twist)
    spine = pelvis.apply(np.array([0.0, 0.0, body.spine]))
    chest_rotation = pelvis.rotation @ pelvis_from_chest
    chest = Transform(spine + chest_rotation[:, :, 2] * body.chest, chest_rotation)
    up, tilt, turn = posture.head_angles.T
    chest_from_head = rotation_about("yxz", tilt, up, turn)
    head_rotation = chest_rotation @ chest_from_head
    neck_direction = normalised(chest_rotation[:, :, 2] + head_rotation[:, :, 2])
    head = Transform(chest.translation + neck_direction * body.neck, head_rotation)
    shoulder = np.array([body.shoulder_half_width, 0.0, -body.shoulder_drop])
    return Trunk(pelvis, chest, head, chest.apply(shoulder), chest.apply(shoulder * MIRROR), spine)


def place_body(
    person: SimulatedPerson, posture: Posture, right_hand: Transform, left_hand: Transform
) -> BodyMotion:
    """The whole body with its hands, world_from_hand (T), as near their targets as arms reach."""
    trunk = place_trunk(person, posture)
    right_arm, right_reached = _reach(
        person, trunk.world_from_chest, trunk.right_shoulder, right_hand
    )
    left_arm, left_reached = _reach(
        person,
        trunk.world_from_chest.mirrored(),
        trunk.left_shoulder * MIRROR,
        left_hand.mirrored(),
    )
    right_leg = _stand_on(person.proportions, trunk, posture.world_from_right_foot, side=1.0)
    left_leg = _stand_on(person.proportions, trunk, posture.world_from_left_foot, side=-1.0)
    joints = [
        trunk.world_from_pelvis.translation,
        trunk.spine,
        trunk.world_from_chest.translation,
        trunk.world_from_head.translation,
        *(points * MIRROR for points in left_arm),
        *right_arm,
        *left_leg,
        *right_leg,
    ]
    return BodyMotion(
        np.stack(joints, axis=1),
        trunk.world_from_pelvis,
        trunk.world_from_chest,
        trunk.world_from_head,
        right_reached,
        left_reached.mirrored(),
    )


def _reach(
    person: SimulatedPerson, from_chest: Transform, shoulder: Array, hand: Transform
) -> tuple[list[Array], Transform]:
    """Shoulder, elbow, wrist and hand (T, 3) of a right arm, and the hand as it was reached."""
    body = person.proportions
    wanted = hand.translation - hand.rotation[:, :, 1] * body.palm
    shoulder = _protract(body, from_chest, shoulder, wanted)
    circle, wrist = _bend(shoulder, wanted, body.upper_arm, body.forearm, ELBOW_EXTENSION)
    elbow = _choose_elbow(person, from_chest, shoulder, wrist, circle, hand)
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
    turned = rotation_about("z", PROTRACTION * across)
    return from_chest.apply(np.einsum("tij,tj->ti", turned, local))


def _choose_elbow(
    person: SimulatedPerson,
    from_chest: Transform,
    shoulder: Array,
    wrist: Array,
    circle: Circle,
    hand: Transform,
) -> Array:
    """The elbow (T, 3) on its circle that is most comfortable: softly the cheapest swivel.

    Costs are squared ratios to what a joint does with ease: the swivel against the person's habit,
    the bend and the twist of the wrist, and an elbow that would press into the chest.
    """
    aside = from_chest.rotation[:, :, 0]
    outward = normalised(aside - circle.axis * np.sum(aside * circle.axis, axis=1, keepdims=True))
    down = np.cross(circle.axis, outward)
    across = (
        np.cos(SWIVELS)[None, :, None] * down[:, None]
        + np.sin(SWIVELS)[None, :, None] * outward[:, None]
    )
    elbows = circle.centre[:, None] + circle.radius[:, None, None] * across
    forearms = normalised(wrist[:, None] - elbows)
    upwards = normalised(shoulder[:, None] - elbows)
    neutral_thumb = normalised(
        upwards - forearms * np.sum(upwards * forearms, axis=2, keepdims=True)
    )
    bend = np.arccos(np.clip(_dots(forearms, hand.rotation[:, :, 1]), -1.0, 1.0))
    twist = np.arccos(np.clip(_dots(neutral_thumb, hand.rotation[:, :, 2]), -1.0, 1.0))
    offset = elbows - from_chest.translation[:, None]
    sideways = _dots(offset, aside)
    ahead = _dots(offset, from_chest.rotation[:, :, 1])
    stout = STOUT_ELBOWS * person.height * max(person.girth - 1.0, 0.0)
    sides = person.proportions.shoulder_half_width + 0.03 + stout
    chest_edge = sides - np.clip(ahead - 0.05 - stout, 0.0, None)
    pressed = np.clip(chest_edge - sideways, 0.0, None)
    cost = (
        _squeeze(person, from_chest, shoulder, elbows)
        + ((SWIVELS - person.manner.elbow_flare) / 0.35) ** 2
        + (bend / 0.9) ** 2
        + (twist / 1.2) ** 2
        + (pressed / 0.03) ** 2
    )
    ease = np.exp(cost.min(axis=1, keepdims=True) - cost)
    swivel = (ease @ SWIVELS) / ease.sum(axis=1)
    chosen = np.cos(swivel)[:, None] * down + np.sin(swivel)[:, None] * outward
    return np.asarray(circle.centre + circle.radius[:, None] * chosen)


def _squeeze(
    person: SimulatedPerson, from_chest: Transform, shoulder: Array, elbows: Array
) -> Array:
    """Cost (T, K) of elbows (T, K, 3) whose upper arms press into ribs or belly."""
    cost = np.zeros(elbows.shape[:2])
    for share, thickness in UPPER_ARM:
        points = shoulder[:, None] + share * (elbows - shoulder[:, None])
        offset = points - from_chest.translation[:, None]
        local = np.einsum("tji,tkj->tki", from_chest.rotation, offset)
        for centre, radii in (rib_cage(person), belly(person)):
            around = radii + thickness * person.height * person.girth
            level = np.linalg.norm((local - centre) / around, axis=2)
            cost += (np.clip(1.0 - level, 0.0, None) / EASY_SQUEEZE) ** 2
    return cost


def _relieve_wrist(forearm: Array, rotation: Array) -> Array:
    """The hand's rotation (T, 3, 3), turned back as far as it bends more than WRIST_LIMIT."""
    fingers = rotation[:, :, 1]
    hinge = np.cross(fingers, forearm)
    sine = np.linalg.norm(hinge, axis=1)
    bend = np.arctan2(sine, np.sum(fingers * forearm, axis=1))
    excess = np.clip(bend - WRIST_LIMIT, 0.0, None) / np.maximum(sine, 1e-9)
    return np.asarray(rotation_from_vector(hinge * excess[:, None]) @ rotation)


def _dots(vectors: Array, against: Array) -> Array:
    """Scalar products (T, K) of vectors (T, K, 3) with one vector (T, 3) a frame."""
    return np.asarray(np.einsum("tkj,tj->tk", vectors, against))


def _stand_on(body: Proportions, trunk: Trunk, foot: Transform, side: float) -> list[Array]:
    """Hip, knee, ankle and foot (T, 3) of the leg on that side; the knee points to the toes."""
    hip = trunk.world_from_pelvis.apply(np.array([side * body.hip_half_width, 0.0, -body.hip_drop]))
    wanted = foot.translation + foot.rotation[:, :, 2] * body.ankle
    circle, ankle = _bend(hip, wanted, body.thigh, body.shank, KNEE_EXTENSION)
    toes = foot.rotation[:, :, 1]
    along = np.sum(toes * circle.axis, axis=1, keepdims=True)
    ahead = normalised(toes - circle.axis * along)
    ball = ankle + foot.rotation @ np.array([0.0, body.foot, BALL_HEIGHT - body.ankle])
    return [hip, circle.centre + circle.radius[:, None] * ahead, ankle, ball]


def _bend(
    root: Array, tip: Array, upper: float, lower: float, extension: float
) -> tuple[Circle, Array]:
    """Two bones from root towards tip: where their middle joint may be, and the tip reached.

    A tip out of reach is brought to the nearest distance that keeps the angle between the bones
    from FLEXION_LIMIT to extension, radians.
    """

    def span(angle: float) -> float:
        return float(np.sqrt(upper**2 + lower**2 - 2.0 * upper * lower * np.cos(angle)))

    offset = tip - root
    length = np.linalg.norm(offset, axis=1, keepdims=True)
    axis = offset / length
    distance = np.clip(length, span(FLEXION_LIMIT), span(extension))
    along = (upper**2 - lower**2 + distance**2) / (2.0 * distance)
    radius = np.sqrt(upper**2 - along[:, 0] ** 2)
    return Circle(axis, root + along * axis, radius), root + distance * axis
