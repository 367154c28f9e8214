"""The prior on objects that are fixed to a hand, so that what is right is known."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from inhand_tracker.body import skeleton as body
from inhand_tracker.body.anchors import ANCHORS, find_anchors
from inhand_tracker.body.window import VIEWS, BodyWindow
from inhand_tracker.mapping.learning import LabelledSequence
from inhand_tracker.prior.combination import fuse, repeated
from inhand_tracker.prior.learning import CHI_SQUARE_90, learn_prior
from inhand_tracker.prior.prior import TARGETS, Prediction, Prior, predict
from people import (
    FRAME_NS,
    HAND,
    STANDING,
    STANDING_HEIGHT,
    WRIST,
    held,
    move,
    quaternion_of,
    scipy_rotation,
    sequence,
    unseen_wave,
    wave_model,
    waving,
    wedge,
)
from scipy.spatial.transform import Rotation

MIDDLE = wedge().marked_vertices.mean(axis=0)
SHIFT = np.array([0.02, -0.05, 0.10])
TWIST = Rotation.from_rotvec([0.3, -0.2, 0.5])


def trunk(joints: np.ndarray) -> np.ndarray:
    """Left, up and forwards as columns (T, 3, 3), by the definition: left is square to up."""
    unit = [
        v / np.linalg.norm(v, axis=1, keepdims=True)
        for v in (
            joints[:, 2] - joints[:, 0],
            joints[:, 4] - joints[:, 8],
            joints[:, 12] - joints[:, 16],
        )
    ]
    up, left = unit[0], unit[1] + unit[2]
    forwards = np.cross(left, up)
    forwards /= np.linalg.norm(forwards, axis=1, keepdims=True)
    return np.stack((np.cross(up, forwards), up, forwards), axis=-1)


def fixed(joints: np.ndarray, name: str = "p") -> LabelledSequence:
    """An object whose middle is fixed to the right palm, in the trunk's directions."""
    axes = trunk(joints)
    turns = Rotation.from_matrix(axes) * TWIST
    palm = 0.5 * (joints[:, WRIST] + joints[:, HAND])
    places = palm + np.einsum("tij,j->ti", axes, SHIFT) - turns.apply(MIDDLE)
    return LabelledSequence(name, False, joints, places, quaternion_of(turns))


@cache
def fixed_prior() -> Prior:
    return learn_prior([fixed(waving(50, seed=s), f"p{s}") for s in range(3)], wedge())


def height_of(joints: np.ndarray) -> float:
    return body.standing_height(body.part_lengths(joints))


def predictions(prior: Prior, joints: np.ndarray) -> list[Prediction]:
    """Frame after frame, as a tracker asks for them."""
    window, height = BodyWindow(), height_of(joints)
    return [
        predict(prior, window.add(one, (n + 1) * FRAME_NS, height), find_anchors(one), height)
        for n, one in enumerate(joints)
    ]


def middle(one: LabelledSequence) -> np.ndarray:
    return one.translations + scipy_rotation(one.rotations).apply(MIDDLE)


def deviations(told: list[Prediction], true: LabelledSequence) -> np.ndarray:
    """(T, 6): translation of the middle and rotation vector on the left."""
    centres = np.array([one.centre for one in told]) - middle(true)
    turns = Rotation.from_matrix([one.rotation for one in told])
    return np.column_stack((centres, (turns * scipy_rotation(true.rotations).inv()).as_rotvec()))


def test_an_object_fixed_to_a_hand_is_predicted_exactly() -> None:
    joints = unseen_wave(60)
    off = deviations(predictions(fixed_prior(), joints), fixed(joints))
    assert np.abs(off[:, :3]).max() < 1e-3
    assert np.abs(off[:, 3:]).max() < np.deg2rad(0.1)


def test_it_is_as_exact_where_the_arm_was_never_seen() -> None:
    """Each anchor extrapolates: in the palm's the object does not move."""
    joints = unseen_wave(30)
    joints[15:, [9, 10, 11]] = joints[15:, [8]] + 0.6 * (joints[15:, [9, 10, 11]] - [0.0, 0.8, 2.0])
    off = deviations(predictions(fixed_prior(), joints), fixed(joints))
    assert np.abs(off[:, :3]).max() < 0.02


small = st.floats(-2.0, 2.0)


@settings(max_examples=25)
@given(st.tuples(small, small, small), st.tuples(small, small, small))
def test_a_person_elsewhere_has_the_object_there(
    turn: tuple[float, ...], shift: tuple[float, ...]
) -> None:
    rotation, joints, prior = Rotation.from_rotvec(turn), unseen_wave(3), wave_model().prior
    assert prior is not None
    here = predictions(prior, joints)[-1]
    there = predictions(prior, move(rotation, np.array(shift), joints))[-1]
    np.testing.assert_allclose(there.centre, rotation.apply(here.centre) + shift, atol=1e-4)
    np.testing.assert_allclose(there.rotation, rotation.as_matrix() @ here.rotation, atol=1e-4)
    axes = np.kron(np.eye(2), rotation.as_matrix())
    expected = axes @ here.covariance @ axes.T
    np.testing.assert_allclose(there.covariance, expected, atol=1e-4 * np.trace(expected))


def test_a_person_half_as_big_holds_it_half_as_far_away() -> None:
    joints = unseen_wave(3)
    big, small_one = (predictions(fixed_prior(), size * joints)[-1] for size in (1.0, 0.5))
    np.testing.assert_allclose(small_one.centre, 0.5 * big.centre, atol=1e-4)
    np.testing.assert_allclose(small_one.rotation, big.rotation, atol=1e-3)


# --- Fusion


def strangers(count: int) -> list[LabelledSequence]:
    """They wave as fast as those learned from, and are others."""
    found = []
    for number in range(count):
        joints = waving(60, seed=20 + number, speed=0.2 + 0.02 * number)
        places, turns = held(joints, seed=20 + number)
        found.append(LabelledSequence(f"s{number}", False, joints, places, turns))
    return found


def single_predictions(prior: Prior, joints: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """What each anchor of each view says by itself: centres (T, E, 3), rotations (T, E, 3, 3)."""
    window, height = BodyWindow(), height_of(joints)
    centres, turns = [], []
    for number, one in enumerate(joints):
        described = window.add(one, (number + 1) * FRAME_NS, height)
        said = np.concatenate(
            [
                regression.predict(description).reshape(len(ANCHORS), TARGETS)
                for regression, description in zip(prior.regressions, described, strict=True)
            ]
        )
        anchors = repeated(find_anchors(one), VIEWS)
        alone = np.eye(VIEWS * len(ANCHORS))
        placed = [
            fuse(said[None], anchors, height, (only[None], only[None]), prior.spread)
            for only in alone
        ]
        centres.append([place[0] for place, _ in placed])
        turns.append([turn[0] for _, turn in placed])
    return np.array(centres), np.array(turns)


@cache
def of_eight() -> Prior:
    return learn_prior([sequence(f"p{seed}", seed=seed) for seed in range(8)], wedge())


def test_all_together_err_hardly_more_than_the_best_alone() -> None:
    """Than the best by hindsight: the object is fixed to the forearm, up to noise of its own, so
    one anchor is all there is to know."""
    together, alone = [], []
    for one in strangers(4):
        told = np.array([said.centre for said in predictions(of_eight(), one.joints)])
        together.append(np.linalg.norm(told - middle(one), axis=1))
        centres, _ = single_predictions(of_eight(), one.joints)
        alone.append(np.linalg.norm(centres - middle(one)[:, None], axis=2))
    each = np.concatenate(alone).mean(axis=0)
    assert np.concatenate(together).mean() < 1.05 * each.min()
    assert np.concatenate(together).mean() < 0.8 * np.median(each)


def test_nine_in_ten_poses_of_unseen_people_lie_within_the_90_percent_region() -> None:
    within = []
    for one in strangers(8):
        told = predictions(of_eight(), one.joints)
        for off, said in zip(deviations(told, one), told, strict=True):
            within.append(off @ np.linalg.solve(said.covariance, off) < CHI_SQUARE_90)
    assert 0.85 <= np.mean(within) <= 0.98


@pytest.mark.parametrize("scale", [0.0, 0.1, 1.0, 10.0, 1e3])
def test_any_body_has_a_finite_pose_and_a_covariance_without_a_flaw(scale: float) -> None:
    prior, random = wave_model().prior, np.random.default_rng(0)
    assert prior is not None
    joints = STANDING + scale * random.normal(size=(20, 3))
    described = BodyWindow().add(joints, FRAME_NS, STANDING_HEIGHT)
    said = predict(prior, described, find_anchors(joints), STANDING_HEIGHT)
    assert np.isfinite(said.centre).all()
    np.testing.assert_allclose(said.rotation.T @ said.rotation, np.eye(3), atol=1e-9)
    assert np.linalg.det(said.rotation) == pytest.approx(1.0)
    np.testing.assert_allclose(said.covariance, said.covariance.T, atol=1e-15)
    assert np.linalg.eigvalsh(said.covariance).min() > 0.0


def test_a_pose_like_none_learned_is_less_sure() -> None:
    prior = wave_model().prior
    assert prior is not None
    usual = predictions(prior, unseen_wave(5))[-1]
    joints = unseen_wave(5)
    joints[:, [9, 10, 11]] += [0.0, -0.9, 0.3]
    odd = predictions(prior, joints)[-1]
    assert np.linalg.det(odd.covariance) > 10.0 * np.linalg.det(usual.covariance)


# --- Handedness, gaps


def mirrored(one: LabelledSequence) -> LabelledSequence:
    places, turns = body.mirror_pose(one.translations, one.rotations, wedge().mirror_normal)
    return LabelledSequence(one.participant, True, body.mirror_joints(one.joints), places, turns)


def test_left_handed_people_teach_what_their_mirror_images_do() -> None:
    sequences = [sequence(f"p{seed}", seed=seed) for seed in range(3)]
    right = learn_prior(sequences, wedge())
    left = learn_prior([mirrored(one) for one in sequences], wedge())
    joints = unseen_wave(5)
    for one, other in zip(predictions(right, joints), predictions(left, joints), strict=True):
        np.testing.assert_allclose(other.centre, one.centre, atol=1e-4)
        np.testing.assert_allclose(other.rotation, one.rotation, atol=1e-4)
        np.testing.assert_allclose(other.covariance, one.covariance, atol=1e-5)


def test_frames_that_are_not_usable_are_left_out() -> None:
    sequences = [sequence(f"p{seed}", seed=seed) for seed in range(3)]
    random, holed = np.random.default_rng(0), []
    for one in sequences:
        joints, places = one.joints.copy(), one.translations.copy()
        joints[random.choice(60, 8, replace=False), 11] = np.nan
        places[random.choice(60, 8, replace=False)] = np.nan
        holed.append(replace(one, joints=joints, translations=places))
    whole, rest = learn_prior(sequences, wedge()), learn_prior(holed, wedge())
    joints = unseen_wave(20)
    for one, other in zip(predictions(whole, joints), predictions(rest, joints), strict=True):
        assert np.linalg.norm(other.centre - one.centre) < 0.01


def test_one_person_s_recordings_hold_each_other_out() -> None:
    prior = learn_prior([sequence("p", seed=seed) for seed in range(3)], wedge())
    assert np.isfinite(prior.errors).all()
    assert prior.calibration > 0.0
    (one,) = strangers(1)
    off = deviations(predictions(prior, one.joints), one)
    assert np.linalg.norm(off[:, :3], axis=1).mean() < 0.02
