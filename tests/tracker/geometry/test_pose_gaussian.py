"""Normal distributions over poses against sample moments, known densities, finite differences."""

import numpy as np
import pytest
from gaussian_sight import alone
from hypothesis import given
from hypothesis import strategies as st
from inhand_tracker.geometry.pose_gaussian import (
    PoseGaussian,
    PoseMixture,
    mixture,
    moved_covariance,
    moved_information,
)
from people import quaternion_of, same_rotation, scipy_rotation
from scipy.spatial.transform import Rotation
from scipy.special import logsumexp
from scipy.stats import multivariate_normal

CENTRE = np.array([0.1, -0.2, 2.0])
TURN = Rotation.from_rotvec([0.4, 1.0, -0.3])


def covariance(seed: int = 0, size: float = 0.05) -> np.ndarray:
    root = np.random.default_rng(seed).normal(size=(6, 6))
    return size**2 * (root @ root.T / 6 + 0.1 * np.eye(6))


def gaussian(seed: int = 0, size: float = 0.05) -> PoseGaussian:
    return PoseGaussian(CENTRE, quaternion_of(TURN), covariance(seed, size))


def test_samples_have_its_mean_and_covariance() -> None:
    one = gaussian()
    centres, turns = alone(one).sample(40_000, np.random.default_rng(1))
    vectors = (scipy_rotation(turns) * TURN.inv()).as_rotvec()
    deviations = np.column_stack((centres - CENTRE, vectors))
    np.testing.assert_allclose(deviations.mean(axis=0), 0.0, atol=1e-3)
    scale = np.sqrt(np.outer(np.diag(one.covariance), np.diag(one.covariance)))
    np.testing.assert_allclose(np.cov(deviations.T) / scale, one.covariance / scale, atol=0.03)


def test_the_density_is_the_normal_one_of_the_deviations() -> None:
    one = gaussian()
    deviations = 0.1 * np.random.default_rng(2).normal(size=(50, 6))
    turns = quaternion_of(Rotation.from_rotvec(deviations[:, 3:]) * TURN)
    expected = multivariate_normal(np.zeros(6), one.covariance).logpdf(deviations)
    np.testing.assert_allclose(
        alone(one).log_densities(CENTRE + deviations[:, :3], turns)[0], expected
    )


def test_the_density_integrates_to_one() -> None:
    """By importance sampling from a wider distribution."""
    one, wide = gaussian(), gaussian(size=0.075)
    poses = alone(wide).sample(40_000, np.random.default_rng(3))
    ratio = np.exp(alone(one).log_densities(*poses)[0] - alone(wide).log_densities(*poses)[0])
    assert ratio.mean() == pytest.approx(1.0, abs=0.05)


@given(st.lists(st.floats(-1.0, 1.0), min_size=6, max_size=6))
def test_deviations_come_back(values: list[float]) -> None:
    deviation = np.array(values)
    turn = quaternion_of(Rotation.from_rotvec(deviation[3:]) * TURN)
    found = gaussian().deviations(CENTRE + deviation[:3], turn)
    np.testing.assert_allclose(found, deviation, atol=1e-9)


def test_the_sign_of_a_quaternion_says_nothing() -> None:
    one = gaussian()
    centres, turns = alone(one).sample(20, np.random.default_rng(4))
    np.testing.assert_allclose(
        alone(one).log_densities(centres, -turns)[0], alone(one).log_densities(centres, turns)[0]
    )


def test_square_distance_is_mahalanobis_to_the_other_s_mean() -> None:
    one = PoseGaussian(CENTRE, quaternion_of(TURN), np.diag([0.01, 1, 1, 0.04, 1, 1.0]))
    moved = Rotation.from_rotvec([0.4, 0.0, 0.0]) * TURN
    other = PoseGaussian(CENTRE + np.array([0.3, 0.0, 0.0]), quaternion_of(moved), np.eye(6))
    assert one.square_distance(other) == pytest.approx(0.09 / 0.01 + 0.16 / 0.04)


@given(st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=3))
def test_a_covariance_and_an_information_move_as_the_point_does(arm: list[float]) -> None:
    """Of x + R(ω) arm by finite differences; a rotation stays what it is."""
    step, lever = 1e-6, np.empty((6, 6))
    for axis in range(6):
        by = step * np.eye(6)[axis]
        points = [
            sign * by[:3] + Rotation.from_rotvec(sign * by[3:]).apply(arm) for sign in (1, -1)
        ]
        lever[:3, axis] = (points[0] - points[1]) / (2 * step)
        lever[3:, axis] = by[3:] / step
    one = covariance(3)
    moved, informed = moved_covariance(one, np.array(arm)), moved_information(one, np.array(arm))
    np.testing.assert_allclose(moved, lever @ one @ lever.T, atol=1e-7)
    np.testing.assert_allclose(informed, lever.T @ one @ lever, atol=1e-7)


def test_a_covariance_moves_there_and_back() -> None:
    one, arm = covariance(2), np.array([0.1, 0.2, -0.3])
    there = moved_covariance(one, arm)
    np.testing.assert_allclose(moved_covariance(there, -arm), one, atol=1e-12)


def two() -> PoseMixture:
    other = Rotation.from_rotvec([0.0, 0.1, 0.1]) * TURN
    parts = (gaussian(0), PoseGaussian(CENTRE + 0.1, quaternion_of(other), covariance(1)))
    return mixture(parts, np.log([2.0, 6.0]) + 1000.0)


def test_a_mixture_s_weights_are_normalised_whatever_their_scale() -> None:
    np.testing.assert_allclose(two().weights, [0.25, 0.75])
    far = mixture(two().parts, np.array([-5000.0, 0.0]))
    assert np.isfinite(far.weights).all()
    np.testing.assert_allclose(far.weights, [0.0, 1.0])


def test_a_mixture_s_moments_are_those_of_its_samples() -> None:
    found = two().moments()
    centres, turns = two().sample(40_000, np.random.default_rng(5))
    deviations = found.deviations(centres, turns)
    np.testing.assert_allclose(deviations.mean(axis=0), 0.0, atol=3e-3)
    scale = np.sqrt(np.outer(np.diag(found.covariance), np.diag(found.covariance)))
    np.testing.assert_allclose(np.cov(deviations.T) / scale, found.covariance / scale, atol=0.05)


def test_the_moments_of_one_part_are_itself() -> None:
    (part, _) = two().parts
    found = PoseMixture((part,), np.ones(1)).moments()
    np.testing.assert_allclose(found.centre, part.centre)
    assert same_rotation(found.rotation, part.rotation)
    np.testing.assert_allclose(found.covariance, part.covariance, atol=1e-12)


def test_a_mixture_s_density_is_the_weighted_sum() -> None:
    centres, turns = two().sample(30, np.random.default_rng(6))
    expected = logsumexp(
        [alone(part).log_densities(centres, turns)[0] for part in two().parts],
        axis=0,
        b=np.array([[0.25], [0.75]]),
    )
    logs = two().log_densities(centres, turns)
    assert logs.shape == (2, 30)
    np.testing.assert_allclose(logsumexp(logs, axis=0), expected)


@pytest.mark.parametrize("count", [1, 2, 3, 7, 400])
@pytest.mark.parametrize("weights", [(0.5, 0.5), (1.0, 0.0), (0.0, 1.0), (0.999, 0.001)])
def test_as_many_samples_come_as_are_asked_for(count: int, weights: tuple[float, float]) -> None:
    chosen = PoseMixture(two().parts, np.array(weights))
    centres, turns = chosen.sample(count, np.random.default_rng(7))
    assert centres.shape == (count, 3)
    assert turns.shape == (count, 4)


def test_a_part_that_weighs_nothing_has_no_density_and_no_warning() -> None:
    chosen = mixture(two().parts, np.array([-5000.0, 0.0]))
    logs = chosen.log_densities(*chosen.sample(3, np.random.default_rng(8)))
    np.testing.assert_array_equal(logs[0], -np.inf)
    assert np.isfinite(logs[1]).all()


def test_parts_that_are_carried_weigh_as_much_as_is_asked_at_the_least() -> None:
    parts = (gaussian(0), gaussian(1), gaussian(2))
    weights = np.array([0.0, 1.0, 0.0])
    kept = PoseMixture(parts, weights, carried=(0, 2)).with_carried(0.2)
    np.testing.assert_allclose(kept.weights, [0.1, 0.8, 0.1])
    enough = PoseMixture(parts, np.array([0.1, 0.7, 0.2]), carried=(0, 2))
    assert enough.with_carried(0.2) is enough
    nothing = PoseMixture(parts, weights)
    assert nothing.with_carried(0.2) is nothing
