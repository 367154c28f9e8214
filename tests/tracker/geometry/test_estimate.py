import numpy as np
import pytest
from inhand_tracker.geometry.estimate import LOST, Estimate, weighted_estimate
from inhand_tracker.geometry.placement import Placement
from people import quaternion_of, same_rotation, scipy_rotation
from scipy.spatial.transform import Rotation

IDENTITY = np.array([1.0, 0.0, 0.0, 0.0])


def about_z(degrees: float) -> np.ndarray:
    return quaternion_of(Rotation.from_euler("z", degrees, degrees=True))


def scattered(count: int = 40, spread: float = 0.2) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    random = np.random.default_rng(9)
    turns = Rotation.from_rotvec([0.5, 1.0, -0.7])
    orientations = Rotation.from_rotvec(spread * random.normal(size=(count, 3))) * turns
    weights = random.random(count)
    translations = random.normal([0.3, -0.2, 2.0], 1.0, (count, 3))
    return translations, quaternion_of(orientations), weights / weights.sum()


def test_the_translation_is_the_weighted_mean() -> None:
    translations, orientations, weights = scattered()
    estimate = weighted_estimate(translations, orientations, weights)
    expected = np.average(translations, axis=0, weights=weights)
    np.testing.assert_allclose(estimate.translation, expected)
    assert estimate.state == "tracked"


def test_the_rotation_is_the_weighted_mean_rotation() -> None:
    translations, orientations, weights = scattered()
    estimate = weighted_estimate(translations, orientations, weights)
    expected = scipy_rotation(orientations).mean(weights)
    assert same_rotation(estimate.rotation, quaternion_of(expected))


def test_the_covariance_is_that_of_translations_and_left_rotation_vectors() -> None:
    translations, orientations, weights = scattered()
    signs = np.where(np.arange(len(weights)) % 3 == 0, -1.0, 1.0)[:, None]
    estimate = weighted_estimate(translations, signs * orientations, weights)
    mean = scipy_rotation(orientations).mean(weights)
    turns = (scipy_rotation(orientations) * mean.inv()).as_rotvec()
    deviations = np.column_stack((translations - weights @ translations, turns))
    expected = np.zeros((6, 6))
    for weight, deviation in zip(weights, deviations, strict=True):
        expected += weight * np.outer(deviation, deviation)
    np.testing.assert_allclose(estimate.covariance, expected, atol=1e-9)
    by_numpy = np.cov(translations.T, aweights=weights, ddof=0)
    np.testing.assert_allclose(estimate.covariance[:3, :3], by_numpy, atol=1e-9)


def test_particles_of_one_pose_are_certain() -> None:
    estimate = weighted_estimate(
        np.tile([0.1, 0.2, 0.3], (5, 1)), np.tile(IDENTITY, (5, 1)), np.full(5, 0.2)
    )
    assert estimate.confidence == pytest.approx(1.0)
    assert estimate.confidence <= 1.0
    np.testing.assert_allclose(estimate.covariance, np.zeros((6, 6)), atol=1e-15)


def test_one_particle_is_its_own_estimate() -> None:
    estimate = weighted_estimate(np.array([[1.0, 2, 3]]), IDENTITY[None], np.array([1.0]))
    assert estimate.translation.tolist() == [1.0, 2.0, 3.0]
    assert estimate.confidence == 1.0


def test_confidence_is_the_weight_near_the_estimate() -> None:
    # Mean at x = 0; of weight 0.2 each: 0, ±9 cm agree and ±11 cm do not.
    x = np.array([0.0, 0.09, -0.09, 0.11, -0.11])
    translations = np.column_stack((x, 0 * x, 0 * x))
    estimate = weighted_estimate(translations, np.tile(IDENTITY, (5, 1)), np.full(5, 0.2))
    assert estimate.confidence == pytest.approx(0.6)


def test_confidence_counts_rotations_within_thirty_degrees() -> None:
    turns = np.array([about_z(a) for a in (0, 29, -29, 31, -31)])
    estimate = weighted_estimate(np.zeros((5, 3)), turns, np.array([0.4, 0.1, 0.1, 0.2, 0.2]))
    assert estimate.confidence == pytest.approx(0.6)


def test_an_estimate_seen_from_another_camera_is_the_same_pose_with_its_covariance() -> None:
    turn = Rotation.from_rotvec([0.2, -1.1, 0.4])
    place = Placement(np.array([0.5, 0.1, -2.0]), turn.as_quat(scalar_first=True))
    deviations = np.diag([0.01, 0.02, 0.03, 0.1, 0.2, 0.3]) ** 2
    here = Estimate("tracked", 0.8, np.array([0.1, 0.2, 1.5]), np.array([1.0, 0, 0, 0]), deviations)
    there = here.seen_from(place)
    assert there.translation == pytest.approx(place.points(here.translation))
    both = np.kron(np.eye(2), turn.as_matrix())
    np.testing.assert_allclose(there.covariance, both @ deviations @ both.T, atol=1e-12)
    assert (there.state, there.confidence) == ("tracked", 0.8)
    assert LOST.seen_from(place) == LOST
