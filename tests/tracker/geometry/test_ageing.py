"""What stands of an estimate while nobody is seen."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from inhand_tracker.geometry.ageing import COASTING_NS, coasted
from inhand_tracker.geometry.estimate import LOST, Estimate

SEEN = Estimate(
    "tracked", 0.8, np.array([0.1, 0.2, 2.0]), np.array([1.0, 0.0, 0.0, 0.0]), 1e-4 * np.eye(6)
)


def test_after_half_a_second_the_pose_stands_and_is_half_as_sure() -> None:
    """0.5 m/s and 2 rad/s for 0.5 s: 25 cm and 1 rad."""
    after = coasted(SEEN, 500_000_000)
    assert after.state == "predicted"
    assert after.confidence == pytest.approx(0.4)
    assert after.translation is SEEN.translation
    assert after.rotation is SEEN.rotation
    spread = np.diag([0.0625, 0.0625, 0.0625, 1.0, 1.0, 1.0])
    np.testing.assert_allclose(after.covariance, 1e-4 * np.eye(6) + spread)


@pytest.mark.parametrize("unseen_ns", [COASTING_NS + 1, 10**18, -1])
def test_after_a_second_or_a_clock_that_jumped_back_it_is_lost(unseen_ns: int) -> None:
    assert coasted(SEEN, unseen_ns) is LOST


def test_nothing_stands_of_what_was_lost() -> None:
    assert coasted(LOST, 1) is LOST


@given(st.integers(0, COASTING_NS), st.integers(0, COASTING_NS))
def test_longer_unseen_is_never_surer(one: int, other: int) -> None:
    early, late = (coasted(SEEN, when) for when in sorted((one, other)))
    assert late.confidence <= early.confidence
    growth = np.linalg.eigvalsh(late.covariance - early.covariance)
    assert (growth >= -1e-12).all()
