"""The prior on objects that are fixed to a hand, so that what is right is known."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from inhand_tracker.body.anchors import ANCHORS, find_anchors
from inhand_tracker.body.window import VIEWS, BodyWindow
from inhand_tracker.mapping.labelled_sequence import LabelledSequence
from inhand_tracker.prior.calibration import CHI_SQUARE_90
from inhand_tracker.prior.combination import fuse
from inhand_tracker.prior.learning import learn_prior
from inhand_tracker.prior.prior import TARGETS, Prior, predict
from people import (
    FRAME_NS,
    HAND,
    STANDING,
    STANDING_HEIGHT,
    WRIST,
    move,
    quaternion_of,
    sequence,
    unseen_wave,
    wave_model,
    waving,
    wedge,
)
from predictions import MIDDLE, deviations, height_of, middle, predictions, strangers
from scipy.spatial.transform import Rotation

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


def test_a_person_half_as_big_has_it_half_as_far_away_in_what_people_did() -> None:
    joints, prior = unseen_wave(3), replace(fixed_prior(), hold=None)
    big, small_one = (predictions(prior, size * joints)[-1] for size in (1.0, 0.5))
    np.testing.assert_allclose(small_one.centre, 0.5 * big.centre, atol=1e-4)
    np.testing.assert_allclose(small_one.rotation, big.rotation, atol=1e-3)


# --- Fusion


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
        anchors = find_anchors(one)
        alone = np.eye(VIEWS * len(ANCHORS))
        placed = [fuse(said, anchors, height, (only, only), prior.spread) for only in alone]
        centres.append([place for place, _ in placed])
        turns.append([turn for _, turn in placed])
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
