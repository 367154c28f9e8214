"""What is carried over from frame to frame, on poses that are known."""

from dataclasses import replace

import numpy as np
import pytest
from inhand_tracker.geometry.pose_gaussian import PoseGaussian
from inhand_tracker.methods.fusion.belief import Belief, carry_over
from inhand_tracker.methods.fusion.parameters import DEFAULT_FUSION
from people import quaternion_of, same_rotation, scipy_rotation
from scipy.spatial.transform import Rotation

SECOND = 1_000_000_000
EXACT = replace(DEFAULT_FUSION, forgetting_s=1e12)
FOR_EVER_S = 1e12


def gaussian(place: list[float], turn: list[float], deviation: float = 0.1) -> PoseGaussian:
    rotation = quaternion_of(Rotation.from_rotvec(turn))
    return PoseGaussian(np.array(place), rotation, deviation**2 * np.eye(6))


EXPECTED = gaussian([0.1, 0.2, 2.0], [0.3, 0.0, 0.5])
BELIEVED = gaussian([0.15, 0.18, 2.02], [0.4, 0.1, 0.5], 0.02)
BEFORE = Belief(EXPECTED, BELIEVED, SECOND)


def in_object(expected: PoseGaussian, pose: PoseGaussian) -> tuple[np.ndarray, np.ndarray]:
    """How a pose differs from the expected one, in its frame: a shift and a rotation vector."""
    inverse = scipy_rotation(expected.rotation).inv()
    shift = inverse.apply(pose.centre - expected.centre)
    return shift, (inverse * scipy_rotation(pose.rotation)).as_rotvec()


def test_the_difference_stays_in_the_object_s_own_frame() -> None:
    now = gaussian([-0.5, 0.4, 1.5], [-1.0, 2.0, 0.2])
    stays, *_ = carry_over(BEFORE, now, 2 * SECOND, FOR_EVER_S, EXACT).parts
    for one, other in zip(in_object(now, stays), in_object(EXPECTED, BELIEVED), strict=True):
        np.testing.assert_allclose(one, other, atol=1e-9)


def test_the_difference_fades_with_the_prior_s_persistence() -> None:
    stays, *_ = carry_over(BEFORE, EXPECTED, 3 * SECOND, 2.0, EXACT).parts
    for one, other in zip(in_object(EXPECTED, stays), in_object(EXPECTED, BELIEVED), strict=True):
        np.testing.assert_allclose(one, np.exp(-1.0) * other, atol=1e-9)


def test_its_covariance_turns_with_it_and_fades_into_the_expected_one() -> None:
    flat = replace(BELIEVED, covariance=np.diag([0.01, 0.04, 0.09, 0.1, 0.2, 0.3]) ** 2)
    before = replace(BEFORE, believed=flat)
    turned = gaussian([0.1, 0.2, 2.0], [0.3, 1.5, 0.5])
    stays, *_ = carry_over(before, turned, 2 * SECOND, FOR_EVER_S, EXACT).parts
    turn = (scipy_rotation(stays.rotation) * scipy_rotation(flat.rotation).inv()).as_matrix()
    axes = np.kron(np.eye(2), turn)
    np.testing.assert_allclose(stays.covariance, axes @ flat.covariance @ axes.T, atol=1e-12)
    late, *_ = carry_over(before, turned, 100 * SECOND, FOR_EVER_S, DEFAULT_FUSION).parts
    np.testing.assert_allclose(late.covariance, turned.covariance, atol=1e-12)


def test_an_object_that_was_left_stays_and_grows_less_certain() -> None:
    now = gaussian([-0.5, 0.4, 1.5], [-1.0, 2.0, 0.2])
    *_, left = carry_over(BEFORE, now, 2 * SECOND, FOR_EVER_S, DEFAULT_FUSION).parts
    np.testing.assert_array_equal(left.centre, BELIEVED.centre)
    assert same_rotation(left.rotation, BELIEVED.rotation)
    grown = np.diag(left.covariance - BELIEVED.covariance)
    np.testing.assert_allclose(grown, np.square([0.01] * 3 + [0.05] * 3))


def test_without_a_reason_to_doubt_each_part_has_its_share() -> None:
    same = Belief(EXPECTED, EXPECTED, SECOND)
    believed = carry_over(same, EXPECTED, 2 * SECOND, 1.0, DEFAULT_FUSION)
    np.testing.assert_allclose(believed.weights, [0.6, 0.2, 0.2])
    assert believed.parts[1] is EXPECTED
    never_left = replace(DEFAULT_FUSION, leaves=False)
    believed = carry_over(same, EXPECTED, 2 * SECOND, 1.0, never_left)
    np.testing.assert_allclose(believed.weights, [0.75, 0.25])


@pytest.mark.parametrize("doubt", [1.0, 4.0])
def test_a_part_that_strays_from_the_expected_pose_loses_weight(doubt: float) -> None:
    """The body walks on by two standard deviations: an object that stayed is less likely."""
    same = Belief(EXPECTED, EXPECTED, SECOND)
    now = replace(EXPECTED, centre=EXPECTED.centre + np.array([0.2, 0.0, 0.0]))
    weights = carry_over(same, now, 2 * SECOND, FOR_EVER_S, replace(EXACT, doubt=doubt)).weights
    assert weights[2] / weights[1] == pytest.approx(np.exp(-0.5 * 2.0**2 / doubt))
    assert weights[0] / weights[1] == pytest.approx(3.0)
