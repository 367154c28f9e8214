"""What is expected of a pose between keyframes."""

from dataclasses import replace

import numpy as np
import pytest
from inhand_lab.labelling.expectations import along_way, carried, fused, near_way
from inhand_lab.labelling.parameters import DEFAULT_LABELLING
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.pose_gaussian import PoseGaussian

UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0])
QUARTER = rotations.from_vector(np.array([0.0, 0.0, 0.5 * np.pi]))


def at(x: float, spread: float = 0.01) -> PoseGaussian:
    return PoseGaussian(np.array([x, 0.0, 2.0]), UPRIGHT, spread**2 * np.eye(6))


def test_an_object_is_carried_as_the_way_goes() -> None:
    way = (np.zeros(3), UPRIGHT), (np.array([0.1, 0.0, 0.0]), QUARTER)
    place, turn = carried((np.array([0.0, 0.5, 2.0]), UPRIGHT), *way)
    np.testing.assert_allclose(place, [0.1, 0.5, 2.0])
    np.testing.assert_allclose(turn, QUARTER)


def test_two_expectations_that_agree_are_surer_together() -> None:
    both, apart = fused(at(0.0), at(0.01))
    np.testing.assert_allclose(both.centre, [0.005, 0.0, 2.0])
    np.testing.assert_allclose(both.covariance, 0.5e-4 * np.eye(6), atol=1e-12)
    assert apart == pytest.approx(np.sqrt(0.5 / 6.0))


def test_two_that_disagree_are_less_sure_by_as_much() -> None:
    both, apart = fused(at(0.0), at(0.3))
    assert apart > 5.0
    np.testing.assert_allclose(both.covariance, apart**2 * 0.5e-4 * np.eye(6), rtol=1e-9)


def test_the_surer_one_counts_more() -> None:
    both, _ = fused(at(0.0, 0.001), at(0.01, 0.01))
    assert both.centre[0] < 0.0002


def test_nothing_is_as_unsure_as_the_middle_between_keyframes() -> None:
    pose = np.zeros(3), UPRIGHT
    spreads = [
        near_way(pose, since, 1.0 - since, DEFAULT_LABELLING).covariance[0, 0]
        for since in (0.1, 0.5, 0.8)
    ]
    assert spreads[1] > max(spreads[0], spreads[2])


def test_a_way_is_left_the_more_the_longer_it_takes() -> None:
    ways = (np.zeros(3), UPRIGHT), (np.zeros(3), UPRIGHT)
    soon, late = (
        along_way(at(0.0), ways, seconds, DEFAULT_LABELLING).covariance[0, 0]
        for seconds in (0.03, 0.3)
    )
    assert at(0.0).covariance[0, 0] < soon < late


def test_less_is_expected_along_the_line_of_sight_where_depth_is_not_measured() -> None:
    unmeasured = replace(DEFAULT_LABELLING, sight_share=0.5)
    pose = np.array([0.0, 0.0, 2.0]), np.array([1.0, 0.0, 0.0, 0.0])
    usual, less = (near_way(pose, 1.0, 1.0, one) for one in (DEFAULT_LABELLING, unmeasured))
    shares = np.sqrt(np.diagonal(less.covariance) / np.diagonal(usual.covariance))
    across, along = shares[0], shares[2]
    assert across == 1.0
    assert 0.5 <= along < 0.52
