"""Joints of several cameras become one."""

import numpy as np
import pytest
from inhand_tracker.rig.joint_fusion import fuse_joints
from inhand_tracker.rig.parameters import RigParameters

SURE = RigParameters(freedom=1e9)
"""By which joints err normally, and fused ones are weighted means."""
X, Y, Z = np.eye(3)


def fused(
    joints: list[np.ndarray],
    rays: list[np.ndarray],
    deviations: list[float],
    parameters: RigParameters = SURE,
    expected: np.ndarray | None = None,
) -> np.ndarray:
    joint, _ = fuse_joints(
        np.array(joints)[:, None],
        np.array(deviations)[:, None],
        np.array(rays)[:, None],
        None if expected is None else expected[None],
        parameters,
    )
    return np.asarray(joint[0])


def test_each_camera_counts_by_its_covariance() -> None:
    first, second = np.array([0.1, 0.0, 0.0]), np.array([0.0, 0.05, 0.2])
    covariances = [
        0.01**2 * (np.eye(3) + (SURE.along_factor**2 - 1.0) * np.outer(Z, Z)),
        0.02**2 * (np.eye(3) + (SURE.along_factor**2 - 1.0) * np.outer(X, X)),
    ]
    information = [np.linalg.inv(one) for one in covariances]
    mean = np.linalg.solve(sum(information), information[0] @ first + information[1] @ second)
    assert fused([first, second], [Z, X], [0.01, 0.02]) == pytest.approx(mean, abs=1e-6)


def test_one_camera_of_three_that_is_far_off_hardly_counts() -> None:
    there = [np.array([0.0, 0.0, 0.0]), np.array([0.01, 0.0, 0.0]), np.array([0.0, 0.3, 0.0])]
    assert np.linalg.norm(fused(there, [Z, X, Z], [0.02] * 3, RigParameters())) < 0.02


def test_of_two_cameras_that_differ_widely_the_one_near_what_was_expected_is_right() -> None:
    there = [np.array([0.0, 0.0, 0.0]), np.array([0.0, 0.3, 0.0])]
    expected = np.array([0.02, 0.01, 0.0])
    assert np.linalg.norm(fused(there, [Z, X], [0.02] * 2, RigParameters(), expected)) < 0.05


def test_what_one_camera_sees_alone_is_as_it_sees_it_and_what_none_sees_is_missing() -> None:
    nan = np.full(3, np.nan)
    joints = np.array([[[0.1, 0.2, 0.3], nan], [nan, nan]])
    rays = np.broadcast_to(Z, joints.shape)
    both, weights = fuse_joints(joints, np.full((2, 2), 0.02), rays, np.zeros((2, 3)))
    assert both[0] == pytest.approx([0.1, 0.2, 0.3])
    assert np.isnan(both[1]).all()
    assert weights[0, 0] > 0.0
    assert weights[1, 0] == weights[0, 1] == weights[1, 1] == 0.0
