"""How an estimate ages while nobody is seen, and when its object is declared lost."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from inhand_tracker.geometry.ageing import aged
from inhand_tracker.geometry.estimate import LOST, Estimate
from inhand_tracker.geometry.parameters import DEFAULT_AGEING, AgeingParameters

LOST_AFTER_NS = DEFAULT_AGEING.lost_after_ns
ESTIMATE = Estimate(
    "tracked", 0.8, np.array([0.1, 0.2, 2.0]), np.array([1.0, 0.0, 0.0, 0.0]), 1e-4 * np.eye(6)
)


def test_after_half_a_second_the_pose_stands_and_is_half_as_sure() -> None:
    """0.5 m/s and 2 rad/s for 0.5 s: 25 cm and 1 rad."""
    after = aged(ESTIMATE, 500_000_000)
    assert after.state == "predicted"
    assert after.confidence == pytest.approx(0.4)
    assert after.translation is ESTIMATE.translation
    assert after.rotation is ESTIMATE.rotation
    spread = np.diag([0.0625, 0.0625, 0.0625, 1.0, 1.0, 1.0])
    np.testing.assert_allclose(after.covariance, 1e-4 * np.eye(6) + spread)


@pytest.mark.parametrize("unseen_ns", [LOST_AFTER_NS + 1, 10**18, -1])
def test_after_a_second_or_a_clock_that_jumped_back_it_is_lost(unseen_ns: int) -> None:
    assert aged(ESTIMATE, unseen_ns) is LOST


def test_a_lost_object_stays_lost() -> None:
    assert aged(LOST, 1) is LOST


def test_objects_that_stay_longer_are_lost_later() -> None:
    patient = AgeingParameters(lost_after_ns=2 * LOST_AFTER_NS)
    assert aged(ESTIMATE, 2 * LOST_AFTER_NS, patient).state == "predicted"


@given(st.integers(0, LOST_AFTER_NS), st.integers(0, LOST_AFTER_NS))
def test_longer_unseen_is_never_surer(one: int, other: int) -> None:
    early, late = (aged(ESTIMATE, when) for when in sorted((one, other)))
    assert late.confidence <= early.confidence
    growth = np.linalg.eigvalsh(late.covariance - early.covariance)
    assert (growth >= -1e-12).all()
