"""Anchors move with the body, and a body without shape breaks none of them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from inhand_schemas.joints import JOINT_NAMES, Joint
from inhand_tracker.body.anchors import ANCHORS, Anchors, find_anchors, trunk_axes
from people import STANDING, move, waving
from scipy.spatial.transform import Rotation

small = st.floats(-3.0, 3.0)
turns = st.tuples(small, small, small).map(Rotation.from_rotvec)
joint_named = JOINT_NAMES.index
shifts = st.tuples(small, small, small).map(np.array)


def at(name: str, anchors: Anchors) -> tuple[np.ndarray, np.ndarray]:
    index = ANCHORS.index(name)
    return anchors.origins[index], anchors.axes[index]


@given(turns, shifts, st.integers(0, 50))
def test_a_body_moved_as_a_whole_takes_every_anchor_along(
    turn: Rotation, shift: np.ndarray, seed: int
) -> None:
    joints = STANDING + 0.05 * np.random.default_rng(seed).normal(size=(20, 3))
    before, after = find_anchors(joints), find_anchors(move(turn, shift, joints))
    np.testing.assert_allclose(after.origins, move(turn, shift, before.origins), atol=1e-9)
    np.testing.assert_allclose(after.axes, turn.as_matrix() @ before.axes, atol=1e-7)


def test_axes_are_rotations_and_many_bodies_are_as_each_alone() -> None:
    joints = waving(12)
    together = find_anchors(joints)
    assert together.origins.shape == (12, len(ANCHORS), 3)
    products = np.swapaxes(together.axes, -1, -2) @ together.axes
    np.testing.assert_allclose(products, np.broadcast_to(np.eye(3), products.shape), atol=1e-9)
    np.testing.assert_allclose(np.linalg.det(together.axes), 1.0)
    for frame, body in enumerate(joints):
        alone = find_anchors(body)
        np.testing.assert_array_equal(together.origins[frame], alone.origins)
        np.testing.assert_array_equal(together.axes[frame], alone.axes)


def test_the_trunk_s_axes_are_left_up_and_forwards() -> None:
    """Who faces the camera has the left at +x, up at -y, and looks along -z."""
    axes = trunk_axes(STANDING)
    np.testing.assert_allclose(axes, np.diag([1.0, -1.0, -1.0]), atol=0.02)


def test_a_forearm_s_anchor_turns_with_it_and_the_hand_s_does_not() -> None:
    still = find_anchors(STANDING)
    joints = STANDING.copy()
    elbow = joints[Joint.ELBOW_RIGHT]
    turn = Rotation.from_rotvec([0.0, 0.0, 0.4])
    for name in ("WristRight", "HandRight"):
        joints[joint_named(name)] = elbow + turn.apply(joints[joint_named(name)] - elbow)
    turned = find_anchors(joints)
    along, before = (at("right forearm", one)[1][:, 2] for one in (turned, still))
    np.testing.assert_allclose(along, turn.apply(before), atol=1e-9)
    np.testing.assert_array_equal(at("right hand", turned)[1], at("right hand", still)[1])
    palm = 0.5 * (joints[Joint.WRIST_RIGHT] + joints[Joint.HAND_RIGHT])
    np.testing.assert_allclose(at("right hand", turned)[0], palm)
    for name in ("trunk", "head", "left forearm", "left hand", "right shank", "left shank"):
        np.testing.assert_array_equal(at(name, turned)[0], at(name, still)[0])


def test_the_hands_anchor_lies_between_them_and_points_to_the_left_one() -> None:
    origin, axes = at("hands", find_anchors(STANDING))
    right, left = (
        0.5 * (STANDING[joint_named(f"Wrist{side}")] + STANDING[joint_named(f"Hand{side}")])
        for side in ("Right", "Left")
    )
    np.testing.assert_allclose(origin, 0.5 * (right + left))
    np.testing.assert_allclose(axes[:, 2], (left - right) / np.linalg.norm(left - right))


def with_joint_at(name: str, other: str) -> np.ndarray:
    joints = STANDING.copy()
    joints[joint_named(name)] = joints[joint_named(other)]
    return joints


def straight_arm() -> np.ndarray:
    joints = STANDING.copy()
    for share, name in enumerate(("Elbow", "Wrist", "Hand"), start=1):
        joints[joint_named(name + "Right")] = joints[Joint.SHOULDER_RIGHT] + [
            0.0,
            0.2 * share,
            0.0,
        ]
    return joints


@pytest.mark.parametrize(
    "joints",
    [
        np.zeros((20, 3)),
        np.tile(STANDING[0], (20, 1)),
        np.outer(np.arange(20.0), [0.0, 0.1, 0.0]),
        with_joint_at("HandRight", "HandLeft"),
        with_joint_at("ShoulderCenter", "HipCenter"),
        with_joint_at("WristRight", "ElbowRight"),
        with_joint_at("ShoulderLeft", "ShoulderRight"),
        straight_arm(),
        1e-200 * STANDING,
    ],
    ids=["origin", "point", "line", "hands", "trunk", "forearm", "shoulders", "straight", "tiny"],
)
def test_a_body_without_shape_has_finite_anchors(joints: np.ndarray) -> None:
    anchors = find_anchors(joints)
    assert np.isfinite(anchors.origins).all()
    assert np.isfinite(anchors.axes).all()
