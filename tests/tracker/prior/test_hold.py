"""How an object is held, for bodies that stand as nobody did who taught."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from inhand_schemas.joints import Joint
from inhand_tracker.body.anchors import ANCHORS, find_anchors
from inhand_tracker.body.holders import HOLDERS, find_holder
from inhand_tracker.body.parameters import DEFAULT_BODY
from inhand_tracker.mapping.learning import LabelledSequence
from inhand_tracker.prior.hold import held_in
from inhand_tracker.prior.learning import learn_prior
from inhand_tracker.prior.prediction import in_camera
from inhand_tracker.prior.prior import Prior
from people import HAND, STANDING, STANDING_HEIGHT, WRIST, quaternion_of, waving, wedge
from predictions import MIDDLE, predictions
from scipy.spatial.transform import Rotation

TABLE = STANDING[Joint.HIP_CENTER] + np.array([0.6, -0.2, -0.5])
GRIP = np.array([0.01, 0.02, 0.05])
TWIST = Rotation.from_rotvec([0.3, -0.2, 0.5])


def gripped(joints: np.ndarray) -> tuple[np.ndarray, Rotation]:
    """The middle (T, 3) and rotations of an object that is fixed to the right forearm."""
    origins, axes = find_holder(find_anchors(joints), HOLDERS.index("right forearm"))
    return origins + axes @ GRIP, Rotation.from_matrix(axes) * TWIST


def who_takes_it_from_a_table(seed: int, *, takes_it: bool = True) -> LabelledSequence:
    """The arm hangs while the object lies on a table, then waves it."""
    still = STANDING + 0.004 * np.random.default_rng(seed).normal(size=(30, 20, 3))
    waved = waving(30, seed=seed, speed=0.2 + 0.02 * seed)
    middles, turns = gripped(waved)
    if not takes_it:
        middles, turns = np.tile(TABLE, (30, 1)), Rotation.identity(30)
    places = np.concatenate((np.tile(TABLE - MIDDLE, (30, 1)), middles - turns.apply(MIDDLE)))
    rotations = np.concatenate((np.tile([1.0, 0.0, 0.0, 0.0], (30, 1)), quaternion_of(turns)))
    return LabelledSequence(f"p{seed}", False, np.concatenate((still, waved)), places, rotations)


@cache
def prior() -> Prior:
    return learn_prior([who_takes_it_from_a_table(seed) for seed in range(4)], wedge())


def as_another_sensor_has_them(joints: np.ndarray) -> np.ndarray:
    """Shoulders 15 cm lower and knees 30 cm further back: about twice as a Kinect of 2010 has them,
    as people here are more alike than real ones."""
    moved = joints.copy()
    shoulders = [Joint.SHOULDER_CENTER, Joint.SHOULDER_LEFT, Joint.SHOULDER_RIGHT]
    moved[:, shoulders, 1] += 0.15 * np.sign(STANDING[Joint.HIP_CENTER, 1] - STANDING[2, 1])
    moved[:, [Joint.KNEE_LEFT, Joint.KNEE_RIGHT], 2] += 0.30
    return moved


def test_where_an_arm_hung_in_training_the_object_lies_on_the_table() -> None:
    predicted = predictions(prior(), np.tile(STANDING, (5, 1, 1)))[-1]
    assert np.linalg.norm(predicted.centre - TABLE) < 0.03


def test_in_a_posture_of_nobody_the_hand_holds_it_and_the_table_is_not_ruled_out() -> None:
    joints = as_another_sensor_has_them(np.tile(STANDING, (5, 1, 1)))
    predicted = predictions(prior(), joints)[-1]
    middles, turns = gripped(joints)
    assert np.linalg.norm(predicted.centre - middles[-1]) < 0.03
    turned = Rotation.from_matrix(predicted.rotation) * turns[-1].inv()
    assert turned.magnitude() < np.deg2rad(10.0)
    to_table = TABLE - predicted.centre
    assert to_table @ np.linalg.solve(predicted.covariance[:3, :3], to_table) < 25.0


def test_the_hold_is_that_of_what_carries_it_and_not_of_where_it_lies() -> None:
    hold = prior().hold
    assert hold is not None
    assert HOLDERS[hold.holder] == "right forearm"
    np.testing.assert_allclose(hold.place * STANDING_HEIGHT, GRIP, atol=0.01)


def test_of_an_object_that_nobody_moves_there_is_no_hold() -> None:
    still = [who_takes_it_from_a_table(seed, takes_it=False) for seed in range(3)]
    assert learn_prior(still, wedge()).hold is None


@pytest.mark.parametrize("holder", range(len(HOLDERS)))
def test_a_holder_moves_with_the_body(holder: int) -> None:
    joints = waving(5)
    turn = Rotation.from_rotvec([0.4, -1.0, 0.3])
    origins, axes = find_holder(find_anchors(joints), holder)
    shift = np.array([0.1, 0.2, 0.3])
    moved = turn.apply(joints.reshape(-1, 3)).reshape(joints.shape) + shift
    moved_origins, moved_axes = find_holder(find_anchors(moved), holder)
    np.testing.assert_allclose(moved_origins, turn.apply(origins) + shift, atol=1e-9)
    np.testing.assert_allclose(moved_axes, turn.as_matrix() @ axes, atol=1e-9)
    np.testing.assert_allclose(np.linalg.det(axes), 1.0, atol=1e-9)


def test_hands_in_one_place_leave_a_finite_hold() -> None:
    joints = waving(1)[0]
    joints[[WRIST, HAND]] = joints[[Joint.WRIST_LEFT, Joint.HAND_LEFT]]
    hold = prior().hold
    assert hold is not None
    held = held_in(hold, find_anchors(joints), STANDING_HEIGHT)
    assert np.isfinite(held.covariance).all()
    np.testing.assert_allclose(held.rotation @ held.rotation.T, np.eye(3), atol=1e-9)


@pytest.mark.parametrize("holder", range(len(HOLDERS)))
def test_a_held_object_is_where_its_holder_takes_it(holder: int) -> None:
    learned = prior().hold
    assert learned is not None
    hold = replace(learned, holder=holder)
    anchors = find_anchors(waving(1)[0])
    origin, axes = find_holder(anchors, holder)
    held = held_in(hold, anchors, STANDING_HEIGHT)
    np.testing.assert_allclose(held.centre, origin + STANDING_HEIGHT * axes @ hold.place)
    np.testing.assert_allclose(held.rotation, axes @ hold.rotation, atol=1e-9)
    np.testing.assert_allclose(
        held.covariance, in_camera(hold.covariance, axes, STANDING_HEIGHT), atol=1e-12
    )


@pytest.mark.parametrize("hand", ["right", "left"])
def test_one_hand_leads_the_way_to_the_other(hand: str) -> None:
    anchors = find_anchors(waving(1)[0])
    other = {"right": "left", "left": "right"}[hand]
    palms = [anchors.origins[ANCHORS.index(f"{one} hand")] for one in (hand, other)]
    forearm = anchors.axes[ANCHORS.index(f"{hand} forearm")]
    way = palms[1] - palms[0] + DEFAULT_BODY.hands_together_m * forearm[:, 1]
    number = HOLDERS.index(f"way from the {hand} hand to the {other}")
    origin, axes = find_holder(anchors, number)
    np.testing.assert_allclose(origin, palms[0])
    np.testing.assert_allclose(axes[:, 2], way / np.linalg.norm(way))
    _, fronted = find_holder(anchors, number - 1)
    np.testing.assert_allclose(fronted[:, 2], forearm[:, 2], atol=1e-9)
    assert abs(fronted[:, 0] @ way) < 1e-9
    assert fronted[:, 1] @ way > 0.0
