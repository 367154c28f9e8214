"""What a look at an image says of whether an object is there."""

import numpy as np
from inhand_tracker.presence import ALIKE, CERTAIN, Looks, Presence

PRESENCE = Presence(np.array([0.0, 0.0]), np.array([20.0, 10.0]), np.array([5.0, 5.0]))
FRAME_NS = 33_333_333


TOLD = 0.8 - np.log(1.0 + ALIKE * (np.exp(0.8) - 1.0))


def test_a_look_says_what_the_ratio_of_both_distributions_is_where_some_things_look_alike() -> None:
    # Of N(10, 5²) over N(0, 5²) at 7: (7² - 3²) / (2 · 25) = 0.8.
    assert abs(PRESENCE.evidence(1, 7.0) - TOLD) < 1e-12
    assert PRESENCE.evidence(0, 10.0) == 0.0


def test_a_look_can_say_more_against_an_object_than_for_it() -> None:
    most, least = PRESENCE.evidence(0, 100.0), PRESENCE.evidence(0, -100.0)
    assert 0.95 * np.log(1.0 / ALIKE) < most < np.log(1.0 / ALIKE)
    assert -CERTAIN <= least < -0.95 * CERTAIN


def test_what_nobody_looked_for_is_told_neither_way() -> None:
    looks = Looks(PRESENCE)
    np.testing.assert_array_equal(looks.evidence(0), np.zeros(3))
    looks.add(0, {1: 7.0})
    np.testing.assert_allclose(looks.evidence(0), [0.0, TOLD, 0.0])


def test_looks_that_say_the_same_do_not_add_up() -> None:
    looks = Looks(PRESENCE)
    for frame in range(100):
        looks.add(frame * FRAME_NS, {1: 7.0})
    np.testing.assert_allclose(looks.evidence(99 * FRAME_NS), [0.0, TOLD, 0.0])


def test_one_look_that_errs_is_outvoted() -> None:
    looks = Looks(PRESENCE)
    for frame in range(20):
        looks.add(frame * FRAME_NS, {0: 16.0})
    looks.add(20 * FRAME_NS, {0: -10.0})
    assert looks.evidence(20 * FRAME_NS)[0] > 0.0


def test_what_was_seen_long_ago_fades() -> None:
    looks = Looks(PRESENCE)
    looks.add(0, {1: 7.0})
    assert 0.0 < looks.evidence(20_000_000_000)[1] < 0.01
    looks.restart()
    assert looks.evidence(0)[1] == 0.0
