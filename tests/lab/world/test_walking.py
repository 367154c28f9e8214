"""Walking: feet stand while the other swings."""

import numpy as np
import pytest
from inhand_lab.world.parameters import DEFAULT_WALK
from inhand_lab.world.walking import Walk

TIMES = np.arange(300) / 30.0
ROUND = Walk(pace=1.8, speed=1.1, radius=0.9, start=0.4, way=1.0)


def test_a_foot_stands_where_it_is_until_it_is_lifted() -> None:
    for side in (1.0, -1.0):
        sole = ROUND.foot(TIMES, side)
        steps = np.linalg.norm(np.diff(sole, axis=0), axis=1)
        stands = sole[:, 2] < 1e-9
        standing = stands[1:] & stands[:-1]
        assert np.count_nonzero(standing) > 30
        assert steps[standing].max() < 1e-9
        assert sole[:, 2].max() == pytest.approx(DEFAULT_WALK.lift, rel=0.1)
        assert sole[:, 2].min() > -1e-9


def test_feet_keep_to_both_sides_of_the_circle() -> None:
    right, left = (np.linalg.norm(ROUND.foot(TIMES, side)[:, :2], axis=1) for side in (1.0, -1.0))
    assert right.mean() > ROUND.radius > left.mean()


def test_who_walks_on_the_spot_stays_there() -> None:
    spot = Walk(pace=1.8, speed=0.0, radius=0.0, start=0.4, way=1.0)
    assert not spot.heading(TIMES).any()
    assert spot.foot(TIMES, -1.0)[:, :2] == pytest.approx(
        np.tile([-DEFAULT_WALK.half_track, 0.0], (300, 1))
    )
