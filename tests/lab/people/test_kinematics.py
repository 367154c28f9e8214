"""Bodies: how limbs reach, and what a mirror image is."""

from dataclasses import replace

import numpy as np
import pytest
from inhand_lab.geometry.transforms import Transform, rotation_about
from inhand_lab.motions.performance import (
    STANCE_HALF_WIDTH,
    Stance,
    feet_apart,
    hanging_hands,
    stand,
)
from inhand_lab.people.kinematics import Posture, place_body, place_trunk
from inhand_lab.people.person import Carriage, SimulatedPerson, sample_person
from inhand_schemas.joints import PARENTS, Joint
from inhand_tracker.geometry.arrays import Array
from performers import angles_at
from solids import depth_in_trunk_and_head, forearm_and_hand, upper_arm

COUNT = 4


def standing(person: SimulatedPerson) -> Posture:
    right_foot, left_foot = feet_apart(person, COUNT)
    still = np.zeros((COUNT, 3))
    stance = Stance(right_foot, left_foot, np.zeros(COUNT), still, still, still)
    return stand(person, np.arange(COUNT) / 30.0, np.random.default_rng(0), stance)


def reach(person: SimulatedPerson, offset: Array, rotation: Array) -> tuple[Transform, Array]:
    """Where the right hand was sent, offset (3,) from its shoulder, and the joints (T, 20, 3)."""
    posture = standing(person)
    trunk = place_trunk(person, posture)
    _, left = hanging_hands(person, trunk, np.random.default_rng(0))
    target = Transform(trunk.right_shoulder + offset, np.broadcast_to(rotation, (COUNT, 3, 3)))
    return target, place_body(person, posture, target, left).joints


@pytest.mark.parametrize(
    ("offset", "turn"),
    [((0.1, 0.35, -0.1), 0.2), ((-0.15, 0.4, 0.0), 0.6), ((0.2, 0.2, -0.3), 0.0)],
)
def test_a_hand_reaches_what_is_within_reach(
    offset: tuple[float, float, float], turn: float
) -> None:
    person = sample_person(4, 1)
    target, joints = reach(person, np.array(offset), rotation_about("z", turn))
    reached = joints[:, Joint.HAND_RIGHT]
    assert np.abs(reached - target.translation).max() < 1e-9


def test_an_arm_stretches_towards_what_is_out_of_reach() -> None:
    person = sample_person(4, 1)
    target, joints = reach(person, np.array([0.0, 2.0, 0.0]), np.eye(3))
    arm = joints[:, Joint.WRIST_RIGHT] - joints[:, Joint.SHOULDER_RIGHT]
    wrist = target.translation - target.rotation[:, :, 1] * person.proportions.palm
    way = wrist - joints[:, Joint.SHOULDER_RIGHT]
    assert np.abs(np.cross(arm, way)).max() < 1e-9
    elbow = angles_at(joints, Joint.SHOULDER_RIGHT, Joint.ELBOW_RIGHT, Joint.WRIST_RIGHT)
    assert elbow == pytest.approx(172.0)


def test_a_shoulder_glides_forward_for_an_arm_across_the_chest_and_keeps_its_bone() -> None:
    person = sample_person(4, 1)
    shoulders = []
    for aside in (0.1, -0.4):
        _, joints = reach(person, np.array([aside, 0.3, 0.0]), np.eye(3))
        chest, shoulder = (joints[0, j] for j in (Joint.SHOULDER_CENTER, Joint.SHOULDER_RIGHT))
        shoulders.append(shoulder - chest)
    resting, gliding = shoulders
    assert 0.02 < gliding[1] - resting[1] < 0.10
    assert np.linalg.norm(gliding) == pytest.approx(np.linalg.norm(resting))


def arm_length(person: SimulatedPerson) -> float:
    return person.proportions.upper_arm + person.proportions.forearm


def test_a_varied_persons_shoulder_goes_after_a_hand_and_keeps_its_bone() -> None:
    person = sample_person(4, 1, "varied")
    ahead = np.array([0.02, 0.0, 0.0])
    palm = np.array([0.0, person.proportions.palm, 0.0])
    forward, elbows, bones = [], [], []
    for share in (0.8, 1.02):
        target, joints = reach(
            person, ahead + palm + [0.0, share * arm_length(person), 0.0], np.eye(3)
        )
        chest, shoulder = (joints[0, j] for j in (Joint.SHOULDER_CENTER, Joint.SHOULDER_RIGHT))
        forward.append((shoulder - chest)[1])
        bones.append(np.linalg.norm(shoulder - chest))
        arm = Joint.SHOULDER_RIGHT, Joint.ELBOW_RIGHT, Joint.WRIST_RIGHT
        elbows.append(angles_at(joints, *arm)[0])
        assert np.abs(joints[:, Joint.HAND_RIGHT] - target.translation).max() < 0.002
    assert forward[1] - forward[0] > 0.015
    assert elbows[1] < 165.0
    assert bones[1] == pytest.approx(bones[0])


@pytest.mark.parametrize("participant", range(12))
def test_an_arm_that_hangs_straight_before_the_hip_keeps_out_of_ribs_and_belly(
    participant: int,
) -> None:
    person = replace(sample_person(4, participant, "varied"), girth=1.13)
    posture = standing(person)
    trunk = place_trunk(person, posture)
    along = np.array([0.02, 0.12, -0.99]) * (arm_length(person) + person.proportions.palm)
    turn = np.broadcast_to(rotation_about("x", -0.5 * np.pi), (COUNT, 3, 3))
    right = Transform(trunk.right_shoulder + along, turn)
    body = place_body(person, posture, right, right.mirrored())
    for part in (upper_arm, forearm_and_hand):
        centres, radii = part(person, body, "right")
        depths = depth_in_trunk_and_head(person, body, centres)
        assert max((depths[name] + radii).max() for name in ("ribs", "belly")) < 0.01


def test_an_elbow_gives_way_before_a_hand_lets_go() -> None:
    person = sample_person(4, 1, "varied")
    flared = replace(person, manner=replace(person.manner, elbow_flare=1.0))
    up = rotation_about("x", 0.5 * np.pi)
    target, joints = reach(flared, np.array([0.0, 0.35, 0.05]), up)
    assert np.abs(joints[:, Joint.HAND_RIGHT] - target.translation).max() < 0.01


def test_a_hand_turns_with_its_forearm_rather_than_break_the_wrist() -> None:
    person = sample_person(4, 1)
    _, joints = reach(person, np.array([0.1, 0.4, -0.1]), rotation_about("z", np.pi))
    wrist = angles_at(joints, Joint.ELBOW_RIGHT, Joint.WRIST_RIGHT, Joint.HAND_RIGHT)
    assert (180.0 - wrist).max() < 75.1


def test_an_elbow_hangs_below_the_line_from_shoulder_to_wrist() -> None:
    person = sample_person(4, 1)
    _, joints = reach(person, np.array([0.1, 0.4, 0.0]), np.eye(3))
    middle = 0.5 * (joints[:, Joint.SHOULDER_RIGHT] + joints[:, Joint.WRIST_RIGHT])
    assert (joints[:, Joint.ELBOW_RIGHT] - middle)[:, 2].max() < -0.05


def test_knees_bend_forward_and_feet_stay_flat_when_the_hips_sink() -> None:
    person = sample_person(4, 2)
    posture = standing(person)
    _, joints = reach(person, np.array([0.1, 0.3, -0.2]), np.eye(3))
    pelvis = posture.world_from_pelvis
    sunk = Posture(
        Transform(pelvis.translation - [0.0, 0.0, 0.3], pelvis.rotation),
        posture.trunk_angles,
        posture.head_angles,
        posture.world_from_right_foot,
        posture.world_from_left_foot,
    )
    hands = hanging_hands(person, place_trunk(person, sunk), np.random.default_rng(0))
    bent = place_body(person, sunk, *hands).joints
    for knee, ankle in ((Joint.KNEE_LEFT, Joint.ANKLE_LEFT), (Joint.KNEE_RIGHT, Joint.ANKLE_RIGHT)):
        assert (bent[:, knee, 1] - joints[:, knee, 1]).min() > 0.1
        assert np.abs(bent[:, ankle] - joints[:, ankle]).max() < 1e-9


def test_a_mirrored_body_is_the_same_bones_on_the_other_side() -> None:
    person = sample_person(4, 3)
    posture = standing(person)
    hands = hanging_hands(person, place_trunk(person, posture), np.random.default_rng(0))
    body = place_body(person, posture, *hands)
    mirrored = body.mirrored()
    assert np.allclose(mirrored.mirrored().joints, body.joints)
    assert np.allclose(
        mirrored.joints[:, Joint.HAND_LEFT], body.joints[:, Joint.HAND_RIGHT] * [-1, 1, 1]
    )
    lengths = [
        np.linalg.norm(each.joints[:, 1:] - each.joints[:, PARENTS[1:]], axis=2).sum()
        for each in (body, mirrored)
    ]
    assert lengths[0] == pytest.approx(lengths[1])


def test_a_carriage_is_how_head_shoulders_feet_and_weight_are_held() -> None:
    usual = sample_person(4, 1)
    own = Carriage(
        head_forward=0.1,
        shoulders_up=0.01,
        shoulders_forward=0.02,
        stance_width=1.5,
        toes_out=0.3,
        foot_ahead=0.04,
        weight_aside=0.02,
    )
    bodies = []
    for person in (usual, replace(usual, carriage=own)):
        posture = standing(person)
        hands = hanging_hands(person, place_trunk(person, posture), np.random.default_rng(0))
        bodies.append(place_body(person, posture, *hands).joints[0])
    (plain, carried), tall = bodies, usual.height
    moved = (carried - carried[Joint.HIP_CENTER]) - (plain - plain[Joint.HIP_CENTER])
    neck = usual.proportions.neck
    chest, head = moved[Joint.SHOULDER_CENTER], moved[Joint.HEAD]
    assert (head - chest)[1] == pytest.approx(0.1 * neck, rel=0.05)
    shoulder = moved[Joint.SHOULDER_RIGHT] - chest
    assert shoulder[1:] == pytest.approx([0.02 * tall, 0.01 * tall], abs=0.002)
    feet = carried[Joint.ANKLE_RIGHT] - carried[Joint.ANKLE_LEFT]
    assert feet[:2] == pytest.approx([1.5 * 2.0 * STANCE_HALF_WIDTH, 0.04 * tall])
    weight = carried[Joint.HIP_CENTER] - plain[Joint.HIP_CENTER]
    assert weight[0] == pytest.approx(0.02 * tall)
    toes = carried[Joint.FOOT_RIGHT] - carried[Joint.ANKLE_RIGHT]
    assert np.arctan2(toes[0], toes[1]) == pytest.approx(0.3)
