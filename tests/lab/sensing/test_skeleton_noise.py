"""What the simulated skeleton tracker makes of true joints."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from inhand_lab.realism.skeleton_properties import hand_bends
from inhand_lab.sensing.skeleton_noise import (
    INFERRED,
    MISSING,
    TRACKED,
    SkeletonReading,
    read_skeleton,
)
from inhand_lab.world.simulation import Simulation, simulate
from inhand_schemas.joints import PARENTS, Joint
from inhand_tracker.geometry.arrays import Array

FRAME_RATE = 30.0


@cache
def simulation() -> Simulation:
    return simulate("sweepFloor", 0, seed=7)


def standing(frames: int) -> Array:
    """The first pose of a person, held for some frames."""
    return np.repeat(simulation().true_joints_in_camera[:1], frames, axis=0)


def swinging(frames: int, speed: float) -> Array:
    """The same person with the right forearm going round at the elbow at a wrist's speed."""
    joints = standing(frames)
    elbow = joints[0, Joint.ELBOW_RIGHT]
    fore = joints[0, Joint.WRIST_RIGHT] - elbow
    length = np.linalg.norm(fore)
    angle = np.arange(frames) / FRAME_RATE * speed / length
    way = np.stack([np.sin(angle), np.cos(angle), np.zeros(frames)], axis=1)
    palm = np.linalg.norm(joints[0, Joint.HAND_RIGHT] - joints[0, Joint.WRIST_RIGHT])
    joints[:, Joint.WRIST_RIGHT] = elbow + length * way
    joints[:, Joint.HAND_RIGHT] = elbow + (length + palm) * way
    return joints


def read(joints: Array, seed: int = 0) -> SkeletonReading:
    random = np.random.default_rng(seed)
    return read_skeleton(simulation().person, joints, FRAME_RATE, random)


def bone(joints: Array, joint: Joint) -> Array:
    return np.asarray(np.linalg.norm(joints[:, joint] - joints[:, PARENTS[joint]], axis=1))


def test_the_same_random_numbers_make_the_same_reading() -> None:
    one, other = (read(swinging(200, 1.0), seed=3) for _ in range(2))
    assert one.joints.tobytes() == other.joints.tobytes()
    assert one.confidences.tobytes() == other.confidences.tobytes()
    assert not np.array_equal(one.joints, read(swinging(200, 1.0), seed=4).joints)


def test_a_resting_body_hardly_trembles_but_is_not_quite_where_it_seems() -> None:
    true = standing(1800)
    joints = read(true).joints
    second = np.linalg.norm(np.diff(joints[:, Joint.SPINE], 2, axis=0), axis=1)
    assert np.median(second) < 0.0005
    errors = []
    for appearance in range(60):
        person = replace(simulation().person, appearance=appearance)
        joints = read_skeleton(person, true[:30], FRAME_RATE, np.random.default_rng(0)).joints
        errors.append(joints[-1] - true[0])
    spread = np.std(np.array(errors)[:, Joint.ELBOW_LEFT], axis=0)
    assert 0.002 < spread.mean() < 0.05


def test_the_faster_the_wrist_the_more_often_it_leaves_the_arm() -> None:
    shares = []
    for speed in (0.1, 0.4, 1.0):
        joints = read(swinging(3600, speed)).joints
        length = bone(joints, Joint.WRIST_RIGHT)
        shares.append(np.mean(np.abs(length / np.median(length) - 1.0) > 0.3))
    assert shares[0] < 0.003 < shares[1] < shares[2] < 0.25


def test_a_moving_hand_flips_now_and_then_and_soon_is_back() -> None:
    arm = (Joint.ELBOW_RIGHT, Joint.WRIST_RIGHT, Joint.HAND_RIGHT)
    back = hand_bends(read(swinging(3600, 1.5)).joints, arm) > 110.0
    assert 0.003 < back.mean() < 0.06
    begins = np.count_nonzero(np.diff(back.astype(int)) == 1)
    assert 1.0 <= back.sum() / begins < 4.0


def test_the_resting_arm_keeps_its_wrist_while_the_other_is_swung() -> None:
    joints = read(swinging(3600, 2.0)).joints
    resting, swung = (bone(joints, joint) for joint in (Joint.WRIST_LEFT, Joint.WRIST_RIGHT))
    assert resting.std() < 0.7 * swung.std()


def test_a_joint_errs_more_where_it_is_inferred() -> None:
    ratios = []
    for interaction in ("pourCream", "putOnGlasses", "recordVideo", "sweepFloor"):
        for participant in range(6):
            one = simulate(interaction, participant, seed=7)
            error = np.linalg.norm(one.joints_in_camera - one.true_joints_in_camera, axis=2)
            inferred, tracked = (one.joint_states == state for state in (INFERRED, TRACKED))
            ratios += [
                error[inferred[:, joint], joint].mean() / error[tracked[:, joint], joint].mean()
                for joint in range(12)
                if inferred[:, joint].any() and tracked[:, joint].any()
            ]
    assert len(ratios) > 20
    assert np.median(ratios) > 1.3


def test_losses_are_short_rare_and_of_the_whole_person() -> None:
    reading = read(standing(36000))
    lost = reading.states == MISSING
    assert np.array_equal(lost.any(axis=1), lost.all(axis=1))
    assert 0.0003 < lost.mean() < 0.01
    assert not lost[0].any()
    begins = np.flatnonzero(np.diff(lost[:, 0].astype(int)) == 1)
    assert 2 < len(begins) < 30
    assert not reading.confidences[lost].any()
    assert reading.confidences[~lost].min() > 0.0
    for begin in begins:
        assert np.array_equal(reading.joints[begin + 1], reading.joints[begin])


def test_confidence_tells_something_and_not_everything() -> None:
    errors, confidences = [], []
    for seed in range(4):
        true = swinging(900, 1.5)
        reading = read(true, seed)
        there = reading.states[:, 0] == TRACKED
        error = np.linalg.norm(reading.joints - true, axis=2)
        errors.append(error[there][:, [Joint.WRIST_RIGHT, Joint.ELBOW_RIGHT]])
        confidences.append(reading.confidences[there][:, [Joint.WRIST_RIGHT, Joint.ELBOW_RIGHT]])
    correlation = np.corrcoef(np.concatenate(errors).ravel(), np.concatenate(confidences).ravel())[
        0, 1
    ]
    assert -0.9 < correlation < -0.3


@pytest.mark.parametrize("frame_rate", [15.0, 60.0])
def test_other_frame_rates_are_read_too(frame_rate: float) -> None:
    random = np.random.default_rng(0)
    reading = read_skeleton(simulation().person, standing(40), frame_rate, random)
    assert np.isfinite(reading.joints).all()
