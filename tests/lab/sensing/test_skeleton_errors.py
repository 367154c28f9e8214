"""Errors of a skeleton tracker by pose and by movement."""

import numpy as np
import pytest
from inhand_lab.sensing.skeleton_errors import inherited, mistake, speeds, stirring, wander
from inhand_lab.sensing.skeleton_noise_parameters import PoseMistakes, WanderingErrors
from inhand_schemas.joints import PARENTS, Joint
from inhand_tracker.geometry.arrays import Array

FRAME_RATE = 30.0
NOISE = WanderingErrors()


def pose(seed: int = 0) -> Array:
    """Joints (1, 20, 3) anywhere within a person's reach."""
    return np.random.default_rng(seed).uniform(-0.8, 0.8, (1, 20, 3))


def test_errors_wander_with_the_way_and_not_with_the_time() -> None:
    random = np.random.default_rng(0)
    still, moving = np.zeros((900, 20)), np.ones((900, 20))
    within_a_second = [
        float(np.std(np.diff(wander(random, speed, FRAME_RATE, NOISE)[::30], axis=0)))
        for speed in (still, moving)
    ]
    assert within_a_second[1] > 3.0 * within_a_second[0]
    assert within_a_second[1] > 0.5e-3 * NOISE.deviations_mm.column.min()


def test_a_mistake_is_the_same_in_the_same_pose_wherever_the_person_stands() -> None:
    joints = pose()
    first = mistake(5, joints, PoseMistakes())
    again = mistake(5, joints + np.array([1.0, 0.2, -0.5]), PoseMistakes())
    assert np.allclose(first, again, atol=1e-12)
    assert not np.allclose(first, mistake(6, joints, PoseMistakes()))
    near = mistake(5, joints + 1e-4 * pose(1), PoseMistakes())
    assert np.abs(near - first).max() < 1e-3


def test_mistakes_have_the_size_that_is_set() -> None:
    noise = PoseMistakes()
    joints = np.concatenate([pose(seed) for seed in range(200)])
    spread = np.sqrt(np.mean(mistake(5, joints, noise) ** 2, axis=(0, 2)))
    wanted = 1e-3 * noise.deviations_mm.column[:, 0]
    elbow = int(Joint.ELBOW_RIGHT)
    assert spread[elbow] == pytest.approx(wanted[elbow], rel=0.3)
    assert spread[0] == 0.0


def test_speeds_and_stirring_are_of_steps_and_saturate() -> None:
    joints = np.repeat(pose(), 4, axis=0)
    joints[:, Joint.HAND_LEFT, 0] += 0.1 * np.arange(4)
    assert speeds(joints, FRAME_RATE)[1:, Joint.HAND_LEFT] == pytest.approx(3.0)
    stirred = stirring(joints, FRAME_RATE, NOISE)
    assert stirred[2, Joint.HAND_LEFT] > 5.0 * stirred[2, Joint.HEAD] > 0.0
    assert stirred.max() < NOISE.most_stirred


def test_a_joint_inherits_its_parents_error_and_slides_along_its_bone() -> None:
    joints, errors = pose(), np.zeros((1, 20, 3))
    errors[0, Joint.SPINE] = [0.1, 0.0, 0.0]
    whole = inherited(errors, joints, NOISE)[0]
    share = NOISE.inherited.column[Joint.SHOULDER_CENTER, 0]
    assert whole[Joint.SHOULDER_CENTER] == pytest.approx(share * whole[Joint.SPINE])
    bone = joints[0, Joint.SPINE] - joints[0, PARENTS[Joint.SPINE]]
    bone /= np.linalg.norm(bone)
    along = bone * (errors[0, Joint.SPINE] @ bone)
    aside = NOISE.aside.column[Joint.SPINE, 0] * (errors[0, Joint.SPINE] - along)
    assert whole[Joint.SPINE] == pytest.approx(along + aside)
    assert not inherited(np.ones((1, 20, 3)), joints, NOISE)[:, 0].any()
