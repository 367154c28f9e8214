"""Learning a prior: what is held out, how far errors go and how long they last."""

from dataclasses import replace

import numpy as np
import pytest
from inhand_tracker.body import skeleton as body
from inhand_tracker.mapping.labelled_sequence import LabelledSequence
from inhand_tracker.prior.calibration import CHI_SQUARE_90, calibration_of
from inhand_tracker.prior.learning import learn_prior, persistence_of
from inhand_tracker.prior.samples import units_of
from people import sequence, unseen_wave, wedge
from predictions import deviations, predictions, strangers
from scipy.spatial.transform import Rotation
from scipy.special import ndtri, stdtrit
from scipy.stats import chi2


def test_the_90_percent_region_is_the_chi_square_distribution_s() -> None:
    assert pytest.approx(chi2.ppf(0.9, 6), abs=1e-3) == CHI_SQUARE_90


@pytest.mark.parametrize("scale", [0.5, 1.0, 3.0])
def test_the_calibration_makes_stated_covariances_true(scale: float) -> None:
    """Of many people's errors, each person's by itself: Student's t hardly adds anything."""
    random = np.random.default_rng(0)
    roots = random.normal(size=(4000, 6, 6)) + 3.0 * np.eye(6)
    errors = scale * np.einsum("lij,lj->li", roots, random.normal(size=(4000, 6)))
    stated = roots @ np.swapaxes(roots, 1, 2)
    factor = calibration_of(stated, errors, 4000)
    assert factor == pytest.approx(scale**2, rel=0.05)


def test_few_people_say_less_of_the_next_one() -> None:
    random = np.random.default_rng(1)
    errors, stated = random.normal(size=(4000, 6)), np.tile(np.eye(6), (4000, 1, 1))
    many, few = (calibration_of(stated, errors, people) for people in (1000, 3))
    assert few / many == pytest.approx((stdtrit(3, 0.95) / ndtri(0.95)) ** 2, rel=0.01)


@pytest.mark.parametrize("lasts_s", [0.2, 1.0, 5.0])
def test_an_error_s_persistence_is_its_time_constant(lasts_s: float) -> None:
    random, step_s = np.random.default_rng(2), 0.1
    kept = np.exp(-step_s / lasts_s)
    errors = np.empty((40_000, 6))
    errors[0] = random.normal(size=6)
    noise = np.sqrt(1.0 - kept**2) * random.normal(size=errors.shape)
    for now in range(1, len(errors)):
        errors[now] = kept * errors[now - 1] + noise[now]
    same = np.zeros(len(errors), int)
    found_s = persistence_of(errors, same, step_s * np.arange(len(errors)), 10.0)
    assert found_s == pytest.approx(lasts_s, rel=0.15)


def test_an_error_that_stays_for_ever_lasts_as_long_as_any_may() -> None:
    errors = np.tile([0.1, 0.2, -0.1, 0.0, 0.3, 0.1], (20, 1))
    times = np.arange(20.0)
    assert persistence_of(errors, np.zeros(20, int), times, 10.0) == pytest.approx(10.0)


def test_frames_of_different_sequences_do_not_follow_each_other() -> None:
    errors = np.random.default_rng(3).normal(size=(20, 6))
    assert persistence_of(errors, np.arange(20), np.arange(20.0), 10.0) == 10.0


def off_by(metres: float, name: str, seed: int) -> LabelledSequence:
    """Somebody who holds the object higher than the others, by a length."""
    one = sequence(name, seed=seed)
    return replace(one, translations=one.translations - np.array([0.0, metres, 0.0]))


def test_errors_are_those_of_people_who_were_held_out() -> None:
    """Two who hold it 20 cm apart: of each the other one only is known."""
    low, high = off_by(0.0, "p0", 0), off_by(0.2, "p1", 1)
    prior = learn_prior([low, high], wedge())
    height = body.stature_of(low.joints)
    upwards = prior.errors[:, 1] * height
    half = len(upwards) // 2
    assert upwards[:half].mean() == pytest.approx(0.2, abs=0.03)
    assert upwards[half:].mean() == pytest.approx(-0.2, abs=0.03)


def turned_about(axis: tuple[float, float, float], seed: int) -> LabelledSequence:
    """The same person takes hold of another side of the object in each recording."""
    one = sequence("p0", seed=seed)
    own = Rotation.from_quat(one.rotations, scalar_first=True)
    turns = own * Rotation.from_rotvec(1.5 * np.array(axis))
    return replace(one, rotations=turns.as_quat(scalar_first=True))


def test_the_region_holds_what_two_recordings_cannot_tell_of_the_third() -> None:
    """Both differ about one axis; how large the next one's difference about another is, is not
    known, and not known to be small."""
    learned = [turned_about((1.0, 0.0, 0.0), 0), turned_about((0.0, 0.0, 0.0), 1)]
    third = turned_about((0.0, 0.0, 1.0), 2)
    predicted = predictions(learn_prior(learned, wedge()), third.joints)
    off = deviations(predicted, third)
    inside = [
        one @ np.linalg.solve(each.covariance, one) <= CHI_SQUARE_90
        for one, each in zip(off, predicted, strict=True)
    ]
    assert np.mean(inside) > 0.9


def test_stretches_of_one_recording_are_one_and_recordings_of_one_person_are_not() -> None:
    recordings = [sequence("p0", seed=seed) for seed in range(3)]
    stretches = [replace(one, recording="long.mcap") for one in recordings]
    people = [replace(one, participant=f"p{n}") for n, one in enumerate(stretches)]
    assert [units_of(some) for some in (recordings, stretches, people)] == [3, 1, 3]
    apart, together = (learn_prior(some, wedge()).calibration for some in (recordings, stretches))
    assert together > 3.0 * apart


def test_the_spread_is_the_covariance_of_the_marked_vertices() -> None:
    prior = learn_prior([sequence(f"p{seed}", seed=seed) for seed in range(2)], wedge())
    marked = wedge().marked_vertices
    np.testing.assert_allclose(prior.centre, marked.mean(axis=0))
    np.testing.assert_allclose(prior.spread, np.cov(marked.T, bias=True))


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
