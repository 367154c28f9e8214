"""How an object is held, for bodies that stand as nobody did who taught."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from inhand_schemas.joints import Joint
from inhand_tracker.body.anchors import find_anchors
from inhand_tracker.body.holders import HOLDERS, Holder, find_holder
from inhand_tracker.mapping.labelled_sequence import LabelledSequence
from inhand_tracker.prior.calibration import CHI_SQUARE_90
from inhand_tracker.prior.combination import rotation_error
from inhand_tracker.prior.hold import rotation_near
from inhand_tracker.prior.learning import learn_prior
from inhand_tracker.prior.prediction import in_camera
from inhand_tracker.prior.prior import Prior
from inhand_tracker.prior.samples import samples_of
from people import HAND, STANDING, WRIST, quaternion_of, waving, wedge
from predictions import MIDDLE, predictions
from scipy.spatial.transform import Rotation

RIGHT_FOREARM = HOLDERS.index(Holder("right forearm", other="left forearm"))
TABLE = STANDING[Joint.HIP_CENTER] + np.array([0.6, -0.2, -0.5])
GRIP = np.array([0.01, 0.02, 0.05])
TWIST = Rotation.from_rotvec([0.3, -0.2, 0.5])


def gripped(joints: np.ndarray) -> tuple[np.ndarray, Rotation]:
    """The middle (T, 3) and rotations of an object that is fixed to the right forearm."""
    origins, axes, _ = find_holder(find_anchors(joints), RIGHT_FOREARM)
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


def as_another_sensor_has_them(joints: np.ndarray, share: float = 1.0) -> np.ndarray:
    """Shoulders 15 cm lower and knees 30 cm further back: about twice as a Kinect of 2010 has them,
    as people here are more alike than real ones."""
    moved = joints.copy()
    shoulders = [Joint.SHOULDER_CENTER, Joint.SHOULDER_LEFT, Joint.SHOULDER_RIGHT]
    moved[:, shoulders, 1] += share * 0.15 * np.sign(STANDING[Joint.HIP_CENTER, 1] - STANDING[2, 1])
    moved[:, [Joint.KNEE_LEFT, Joint.KNEE_RIGHT], 2] += share * 0.30
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
    assert hold.holder == RIGHT_FOREARM
    np.testing.assert_allclose(hold.pull, 0.0)
    np.testing.assert_allclose(TWIST.apply(-hold.grip), GRIP, atol=0.01)


def test_of_an_object_that_nobody_moves_there_is_no_hold() -> None:
    still = [who_takes_it_from_a_table(seed, takes_it=False) for seed in range(3)]
    assert learn_prior(still, wedge()).hold is None


def with_a_bar(seed: int) -> LabelledSequence:
    """Both hands hold a bar, along its x axis, which turns in the right fist as they move."""
    joints = waving(40, seed=seed, speed=0.2 + 0.02 * seed)
    origins, axes, ways = find_holder(find_anchors(joints), RIGHT_FOREARM)
    along = ways / np.linalg.norm(ways, axis=1, keepdims=True)
    across = np.cross(along, axes[:, :, 2])
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    turns = Rotation.from_matrix(np.stack((along, across, np.cross(along, across)), axis=2))
    return LabelledSequence(
        f"p{seed}", False, joints, origins - turns.apply(MIDDLE), quaternion_of(turns)
    )


def test_what_both_hands_hold_turns_towards_the_other_hand() -> None:
    hold = learn_prior([with_a_bar(seed) for seed in range(4)], wedge()).hold
    assert hold is not None
    assert HOLDERS[hold.holder].other is not None
    assert abs(hold.pull[0]) > 10.0 * np.abs(hold.pull[1:]).max()
    other = with_a_bar(9)
    held = hold.of(find_anchors(other.joints))
    off = (
        Rotation.from_matrix(held.rotation)
        * Rotation.from_quat(other.rotations, scalar_first=True).inv()
    )
    alone = replace(hold, pull=np.zeros(3)).of(find_anchors(other.joints))
    off_alone = (
        Rotation.from_matrix(alone.rotation)
        * Rotation.from_quat(other.rotations, scalar_first=True).inv()
    )
    assert off.magnitude().mean() < 0.5 * off_alone.magnitude().mean()


LOST_M = 0.1
"""Metres from the other hand to where the user's sensor has it."""


def test_a_users_sensor_that_loses_the_other_hand_does_not_undo_that_both_hold() -> None:
    people = [with_a_bar(seed) for seed in range(4)]
    own = []
    for take in range(5):
        seen = with_a_bar(10 + take)
        seen.joints[:, [Joint.WRIST_LEFT, Joint.HAND_LEFT]] += np.array([0.0, LOST_M, 0.0])
        own.append(replace(seen, participant="user", own=True))
    alone, joined = (learn_prior(some, wedge()).hold for some in (people, [*people, *own]))
    assert alone is not None
    assert joined is not None
    assert joined.holder == alone.holder
    assert np.linalg.norm(joined.pull) > 0.3 * np.linalg.norm(alone.pull)


def test_between_regressions_and_the_hold_the_truth_is_where_it_was_of_people_held_out() -> None:
    learned = prior()
    assert learned.hold is not None
    joints = np.tile(STANDING, (5, 1, 1))
    by_people = predictions(replace(learned, hold=None), joints)[-1]
    by_hold = learned.hold.of(find_anchors(joints[-1]))
    landmarks = np.ones(len(learned.hold.leanings))
    for share in (0.0, 0.3, 1.0):
        leanings = np.stack((share * landmarks, landmarks), axis=1)
        hold = replace(learned.hold, leanings=leanings)
        predicted = predictions(replace(learned, hold=hold), joints)[-1]
        expected = by_people.centre + share * (by_hold.centre - by_people.centre)
        np.testing.assert_allclose(predicted.centre, expected, atol=1e-6)


def test_what_leans_towards_the_hold_is_the_truth_of_people_who_were_held_out() -> None:
    """On the table the hold is far off, and regressions are right."""
    learned = prior()
    assert learned.hold is not None
    towards, square = learned.hold.leanings.T
    on_table = np.linalg.norm(learned.landmark_targets[:, 0, :3], axis=1) > 0.3
    assert on_table.any()
    assert np.abs(towards[on_table] / square[on_table]).max() < 0.1


@pytest.mark.parametrize("holder", range(len(HOLDERS)))
def test_a_holder_moves_with_the_body(holder: int) -> None:
    joints = waving(5)
    turn = Rotation.from_rotvec([0.4, -1.0, 0.3])
    origins, axes, ways = find_holder(find_anchors(joints), holder)
    shift = np.array([0.1, 0.2, 0.3])
    moved = turn.apply(joints.reshape(-1, 3)).reshape(joints.shape) + shift
    moved_origins, moved_axes, moved_ways = find_holder(find_anchors(moved), holder)
    np.testing.assert_allclose(moved_origins, turn.apply(origins) + shift, atol=1e-9)
    np.testing.assert_allclose(moved_axes, turn.as_matrix() @ axes, atol=1e-9)
    np.testing.assert_allclose(moved_ways, turn.apply(ways), atol=1e-9)


def test_hands_in_one_place_leave_a_finite_hold() -> None:
    joints = waving(1)[0]
    joints[[WRIST, HAND]] = joints[[Joint.WRIST_LEFT, Joint.HAND_LEFT]]
    hold = prior().hold
    assert hold is not None
    held = replace(hold, pull=np.array([5.0, 0.0, 0.0])).of(find_anchors(joints))
    assert np.isfinite(held.covariance).all()
    np.testing.assert_allclose(held.rotation @ held.rotation.T, np.eye(3), atol=1e-9)


def test_a_held_object_is_where_the_forearm_and_the_other_hand_take_it() -> None:
    learned = prior().hold
    assert learned is not None
    hold = replace(learned, pull=np.array([3.0, -1.0, 2.0]))
    anchors = find_anchors(waving(1)[0])
    origin, axes, way = find_holder(anchors, hold.holder)
    held = hold.of(anchors)
    rotation = rotation_near(axes @ hold.rotation + np.outer(way, hold.pull))
    np.testing.assert_allclose(held.rotation, rotation, atol=1e-9)
    np.testing.assert_allclose(held.centre, origin - rotation @ hold.grip)
    covariance = in_camera(hold.covariance, rotation, 1.0)
    np.testing.assert_allclose(held.covariance, covariance, atol=1e-12)


def test_the_stranger_the_posture_the_wider_the_region() -> None:
    standing = np.tile(STANDING, (5, 1, 1))
    sizes = [
        np.linalg.det(predictions(prior(), joints)[-1].covariance)
        for joints in (as_another_sensor_has_them(standing, share) for share in (0.2, 0.4, 0.6))
    ]
    assert sizes == sorted(sizes)


def test_what_people_did_in_such_postures_lies_in_the_region_however_strange() -> None:
    joints = as_another_sensor_has_them(np.tile(STANDING, (5, 1, 1)))
    predicted = predictions(prior(), joints)[-1]
    by_people = predictions(replace(prior(), hold=None), joints)[-1]
    off = np.concatenate(
        (
            by_people.centre - predicted.centre,
            rotation_error(by_people.rotation, predicted.rotation),
        )
    )
    assert off @ np.linalg.solve(predicted.covariance, off) < CHI_SQUARE_90


def who_holds_it_all_the_time(participant: str, *, own: bool = False) -> LabelledSequence:
    """A body of another sensor whose hanging arm holds the object."""
    random = np.random.default_rng(len(participant))
    joints = as_another_sensor_has_them(STANDING + 0.004 * random.normal(size=(60, 20, 3)))
    joints = joints + np.linspace(0.0, 2.0, 60)[:, None, None] * np.array([1.0, 0.0, 0.0])
    middles, turns = gripped(joints)
    places = middles - turns.apply(MIDDLE)
    return LabelledSequence(participant, False, joints, places, quaternion_of(turns), own=own)


def test_where_the_hold_was_better_for_who_was_held_out_it_counts_in_known_postures_too() -> None:
    people = [who_takes_it_from_a_table(seed) for seed in range(4)]
    joined = learn_prior([*people, who_holds_it_all_the_time("user", own=True)], wedge())
    joints = who_holds_it_all_the_time("other").joints
    middles, _ = gripped(joints)
    predicted = predictions(joined, joints)[-1]
    assert np.linalg.norm(predicted.centre - middles[-1]) < 0.03
    lying = predictions(joined, np.tile(STANDING, (5, 1, 1)))[-1]
    assert np.linalg.norm(lying.centre - TABLE) < 0.03


def test_a_users_own_recordings_weigh_as_much_as_all_others() -> None:
    people = [who_takes_it_from_a_table(seed) for seed in range(4)]
    own = replace(who_takes_it_from_a_table(5), own=True)
    samples = samples_of([*people, own], wedge(), MIDDLE, 8)
    assert samples.weights().sum() == pytest.approx(1.0)
    assert samples.weights()[samples.own].sum() == pytest.approx(0.5)
    assert samples_of([own], wedge(), MIDDLE, 8).weights().sum() == pytest.approx(1.0)
