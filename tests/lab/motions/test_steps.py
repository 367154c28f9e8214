"""Turning on the spot."""

import numpy as np
import pytest
from inhand_lab.motions.steps import Turn, turn_on_the_spot

TIMES = np.arange(0.0, 4.0, 0.02)
THERE_AND_BACK = (Turn(0.5, 1.5, -0.9), Turn(2.0, 3.0, 0.0))


def test_body_and_feet_arrive_at_each_heading() -> None:
    footing = turn_on_the_spot(TIMES, 0.12, THERE_AND_BACK)
    turned = (TIMES > 1.5) & (TIMES < 2.0)
    assert footing.heading[turned] == pytest.approx(-0.9)
    assert footing.foot_turns[turned] == pytest.approx(-0.9)
    assert footing.heading[-1] == pytest.approx(0.0)
    assert np.allclose(footing.right_foot[-1], [0.12, 0.0, 0.0])
    assert np.allclose(footing.left_foot[-1], [-0.12, 0.0, 0.0])


def test_one_foot_is_always_on_the_floor_and_a_turning_one_never() -> None:
    footing = turn_on_the_spot(TIMES, 0.12, THERE_AND_BACK)
    heights = np.stack([footing.right_foot[:, 2], footing.left_foot[:, 2]], axis=1)
    assert heights.max() == pytest.approx(0.05, abs=1e-3)
    assert np.abs(heights.min(axis=1)).max() < 1e-12
    planted = (heights[1:] < 1e-9) & (heights[:-1] < 1e-9)
    assert np.abs(np.diff(footing.foot_turns, axis=0))[planted].max() < 1e-6


def test_the_foot_on_the_inner_side_goes_first() -> None:
    right, left = (
        turn_on_the_spot(TIMES, 0.12, [Turn(1.0, 2.0, heading)]) for heading in (-0.5, 0.5)
    )
    early = 65
    assert right.right_foot[early, 2] > 0.0
    assert left.left_foot[early, 2] > 0.0
