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

from inhand_lab.geometry.transforms import MIRROR, Transform, normalised, rotation_about
from inhand_lab.people.arm_reach import reach_with_arm
from inhand_lab.people.body_motion import BodyMotion
from inhand_lab.people.parameters import DEFAULT_LIMITS
from inhand_lab.people.person import Proportions, SimulatedPerson
from inhand_lab.people.two_bones import bend_towards

BALL_HEIGHT = 0.02
"""Height of the ball of a foot above the floor, metres."""


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
    neck = chest_rotation[:, :, 2] + head_rotation[:, :, 2]
    length = np.linalg.norm(neck, axis=1, keepdims=True)
    neck += np.tan(person.carriage.head_forward) * length * chest_rotation[:, :, 1]
    head = Transform(chest.translation + normalised(neck) * body.neck, head_rotation)
    shoulder = np.array([body.shoulder_half_width, 0.0, -body.shoulder_drop])
    carried = [0.0, person.carriage.shoulders_forward, person.carriage.shoulders_up]
    shoulder += person.height * np.array(carried)
    return Trunk(pelvis, chest, head, chest.apply(shoulder), chest.apply(shoulder * MIRROR), spine)


def place_body(
    person: SimulatedPerson, posture: Posture, right_hand: Transform, left_hand: Transform
) -> BodyMotion:
    """The whole body with its hands, world_from_hand (T), as near their targets as arms reach."""
    trunk = place_trunk(person, posture)
    right_arm, right_reached = reach_with_arm(
        person, trunk.world_from_chest, trunk.right_shoulder, right_hand
    )
    left_arm, left_reached = reach_with_arm(
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


def _stand_on(body: Proportions, trunk: Trunk, foot: Transform, side: float) -> list[Array]:
    """Hip, knee, ankle and foot (T, 3) of the leg on that side; the knee points to the toes."""
    hip = trunk.world_from_pelvis.apply(np.array([side * body.hip_half_width, 0.0, -body.hip_drop]))
    wanted = foot.translation + foot.rotation[:, :, 2] * body.ankle
    circle, ankle = bend_towards(
        hip, wanted, (body.thigh, body.shank), DEFAULT_LIMITS.knee_extension
    )
    toes = foot.rotation[:, :, 1]
    along = np.sum(toes * circle.axis, axis=1, keepdims=True)
    ahead = normalised(toes - circle.axis * along)
    ball = ankle + foot.rotation @ np.array([0.0, body.foot, BALL_HEIGHT - body.ankle])
    return [hip, circle.centre + circle.radius[:, None] * ahead, ankle, ball]
