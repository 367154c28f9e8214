"""What is read of arms, of whatever sensor, and at whatever rate."""

import numpy as np
import pytest
from arm_paths import LIFT_AND_SWEEP, POSE, arm_pose, arm_poses
from inhand_schemas.joints import Joint
from inhand_tracker.recognition.arm_movement import MOVED, WRISTS, ArmReader, arm_description
from inhand_tracker.recognition.parameters import DEFAULT_RECOGNITION

RATE_HZ = DEFAULT_RECOGNITION.arms.rate_hz


def observations(rate_hz: float) -> np.ndarray:
    reader = ArmReader()
    poses = arm_poses(LIFT_AND_SWEEP, rate_hz)
    return np.array([one for time_ns, pose in poses for one in reader.read(time_ns, pose)])


def test_what_a_sensor_decides_for_itself_is_not_read() -> None:
    moved = POSE.copy()
    moved[[Joint.SPINE, Joint.HIP_CENTER, Joint.HEAD, Joint.SHOULDER_CENTER]] += 0.04
    moved[[Joint.HAND_LEFT, Joint.HAND_RIGHT, Joint.FOOT_LEFT, Joint.FOOT_RIGHT]] -= 0.06
    described = arm_description(POSE.ravel())
    np.testing.assert_allclose(arm_description(moved.ravel()), described)
    np.testing.assert_allclose(arm_description(1.2 * POSE.ravel()), described)


def test_a_pelvis_that_leans_otherwise_changes_nothing() -> None:
    angle = np.deg2rad(30.0)
    cos, sin = np.cos(angle), np.sin(angle)
    lean = np.array([[1.0, 0.0, 0.0], [0.0, cos, -sin], [0.0, sin, cos]])
    np.testing.assert_allclose(
        arm_description((POSE @ lean.T).ravel()), arm_description(POSE.ravel()), atol=1e-12
    )


def test_a_wrist_is_placed_to_the_left_up_and_ahead_of_the_shoulders() -> None:
    right = arm_description(arm_pose(0.0, 0.0))[:3]
    np.testing.assert_allclose(right, [-0.35, 0.0, 1.0], atol=0.03)
    np.testing.assert_allclose(arm_description(arm_pose(90.0, 0.0))[:3], [-1.35, 0, 0], atol=0.03)


@pytest.mark.parametrize("rate_hz", [15.0, 20.0, 24.0, 60.0])
def test_observations_are_the_same_at_any_rate_of_frames(rate_hz: float) -> None:
    usual, other = observations(30.0), observations(rate_hz)
    assert abs(len(other) - len(usual)) <= 1
    both = min(len(other), len(usual))
    np.testing.assert_allclose(other[:both], usual[:both], atol=0.05)


def test_an_observation_says_how_far_wrists_moved_in_a_fifth_of_a_second() -> None:
    some = observations(30.0)
    lag = round(0.2 * RATE_HZ)
    np.testing.assert_allclose(some[10, MOVED], some[10, WRISTS] - some[10 - lag, WRISTS])


def test_after_a_long_gap_nothing_has_moved() -> None:
    reader = ArmReader()
    reader.read(0, arm_pose(0.0, -85.0))
    (after,) = reader.read(5_000_000_000, arm_pose(0.0, 30.0))
    np.testing.assert_array_equal(after[MOVED], 0.0)
    (again,) = reader.read(1_000_000_000, arm_pose(90.0, 30.0))
    np.testing.assert_array_equal(again[MOVED], 0.0)
