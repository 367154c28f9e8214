"""Smoothing of joints."""

import numpy as np
import pytest
from inhand_capture.estimation.one_euro import OneEuroFilter

PERIOD_S = 1.0 / 30.0


def test_a_joint_at_rest_trembles_less_and_one_that_moves_is_hardly_late() -> None:
    random = np.random.default_rng(0)
    noise = random.normal(0.0, 0.01, (90, 1, 3))
    still = OneEuroFilter(1)
    rested = np.array([still.smooth(place, PERIOD_S) for place in noise])
    assert rested[30:].std() < 0.6 * noise[30:].std()
    moving = OneEuroFilter(1)
    for number in range(60):
        place = np.array([[2.0 * number * PERIOD_S, 0.0, 2.0]])
        smoothed = moving.smooth(place, PERIOD_S)
    assert place[0, 0] - smoothed[0, 0] < 0.06


def test_a_missing_joint_stays_missing_and_begins_anew() -> None:
    filter_ = OneEuroFilter(2)
    first = np.array([[0.0, 0.0, 2.0], [1.0, 0.0, 2.0]])
    np.testing.assert_array_equal(filter_.smooth(first, PERIOD_S), first)
    gone = first.copy()
    gone[1] = np.nan
    assert np.isnan(filter_.smooth(gone, PERIOD_S)[1]).all()
    back = first + np.array([0.0, 0.5, 0.0])
    assert filter_.smooth(back, PERIOD_S)[1] == pytest.approx(back[1])
