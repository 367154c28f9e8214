"""Whether somebody can have turned as a network says."""

import numpy as np
import pytest
from inhand_capture.estimation.facing import agreement, begun_with
from inhand_capture.estimation.landmarks import POINTS, Landmarks
from inhand_capture.estimation.regions import Region

LEFT_SHOULDER, RIGHT_SHOULDER, LEFT_HIP, RIGHT_HIP = 11, 12, 23, 24


def turned(shoulders: float, hips: float) -> Landmarks:
    """Somebody whose shoulders and hips are turned by so many degrees from facing the camera."""
    places = np.zeros((POINTS, 3))
    for left, right, turn in (
        (LEFT_SHOULDER, RIGHT_SHOULDER, shoulders),
        (LEFT_HIP, RIGHT_HIP, hips),
    ):
        across = np.array([np.cos(np.radians(turn)), 0.0, np.sin(np.radians(turn))])
        places[left], places[right] = 0.2 * across, -0.2 * across
    region = Region(300.0, 200.0, 250.0)
    return Landmarks(places[:, :2], places, np.ones(POINTS), 1.0, region)


def test_the_part_that_has_turned_more_counts() -> None:
    before = begun_with(turned(0.0, 0.0))
    assert agreement(turned(0.0, 0.0), before) == pytest.approx(1.0)
    assert agreement(turned(0.0, 60.0), before) == pytest.approx(0.5)
    assert agreement(turned(180.0, 0.0), before) == pytest.approx(-1.0)


def test_one_exchanged_picture_does_not_change_how_somebody_has_lain() -> None:
    followed = begun_with(turned(30.0, 30.0)).after(turned(210.0, 210.0), 0.1)
    assert agreement(turned(30.0, 30.0), followed) == pytest.approx(1.0)


def test_a_network_that_goes_on_about_it_is_believed() -> None:
    followed = begun_with(turned(0.0, 0.0))
    for _ in range(10):
        followed = followed.after(turned(180.0, 180.0), 0.1)
    assert agreement(turned(180.0, 180.0), followed) == pytest.approx(1.0)


def test_what_is_looked_at_next_is_what_the_network_says() -> None:
    region = Region(10.0, 20.0, 30.0)
    there = turned(0.0, 0.0)
    moved = Landmarks(there.pixels, there.places, there.visibilities, 1.0, region)
    assert begun_with(there).after(moved, 0.1).region == region
