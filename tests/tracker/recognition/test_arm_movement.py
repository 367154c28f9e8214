"""What is read of arms, and what it says, on two actions that one number tells apart."""

import numpy as np
import pytest
from inhand_schemas.joints import Joint
from inhand_tracker.recognition.arm_movement import arm_description, arm_evidence
from inhand_tracker.recognition.movement_classes import MovementClasses
from inhand_tracker.recognition.parameters import DEFAULT_RECOGNITION
from people import STANDING

POSE = (STANDING - STANDING[Joint.HIP_CENTER]) / 1.7
NONE_AT, ACTIONS_AT = 0.0, (-8.0, 8.0)


def classes() -> MovementClasses:
    """Two actions on both sides of nothing in use."""
    return MovementClasses(
        means=np.zeros(1),
        whitening=np.eye(1),
        directions=np.eye(1),
        centres=np.array([[ACTIONS_AT[0]], [ACTIONS_AT[1]], [NONE_AT]]),
        log_shares=np.log(np.array([0.1, 0.3, 0.6])),
        says=np.ones((3, 3)),
        limits=np.full(2, np.inf),
        reaches=np.full(2, np.inf),
        owners=np.array([0, 1, 2]),
    )


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


@pytest.mark.parametrize("action", [0, 1])
def test_arms_speak_for_the_action_they_are_near_to(action: int) -> None:
    features = np.array([[ACTIONS_AT[action]], [NONE_AT]])
    of_action, of_none = arm_evidence(classes(), features)
    assert of_action[action] > 5.0
    assert of_action[1 - action] < -20.0
    assert of_none[:2].max() < -20.0


def test_far_from_all_that_was_learned_arms_say_nothing_for_any_action() -> None:
    far = np.array([[1000.0], [-1000.0]])
    assert arm_evidence(classes(), far)[:, :2].max() < 0.0
    bound = DEFAULT_RECOGNITION.most_said - DEFAULT_RECOGNITION.arm_caution
    assert arm_evidence(classes(), np.array([[12.0]]))[0, 1] == pytest.approx(bound)
