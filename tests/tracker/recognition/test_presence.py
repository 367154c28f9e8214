"""What a look at an image says of whether an object is there."""

from dataclasses import replace

import numpy as np
import pytest
from inhand_tracker.recognition.parameters import DEFAULT_RECOGNITION
from inhand_tracker.recognition.presence import Looks, Presence, usual_presence
from inhand_tracker.sight.support import Support

TRUST = DEFAULT_RECOGNITION.trust
MOST_AGAINST = DEFAULT_RECOGNITION.most_against
PART_TEMPER = DEFAULT_RECOGNITION.part_temper
RECOLOURED_SPREAD = DEFAULT_RECOGNITION.recoloured_spread

PRESENCE = Presence(
    np.array([[20.0, 0.0], [0.0, 10.0]]),
    np.array([5.0, 5.0]),
    np.array([[5.0, 10.0, 1.0, 4.0], [-np.inf, -np.inf, -np.inf, -np.inf]]),
    np.array([[2.0, 4.0, 0.5, 1.0]] * 2),
)
FRAME_NS = 33_333_333
TOLD = TRUST + np.log(2.0 / (1.0 + np.exp(-0.8)))
"""At 7, N(10, 5²) is exp(0.8) times N(0, 5²): (7² - 3²) / (2 · 25) = 0.8."""


def so_likely(log_likelihood: float) -> Support:
    """One of which no part falls short of the first object's, but the last."""
    return Support(5.0, 10.0, 1.0, log_likelihood - 16.0)


def test_a_look_says_how_much_likelier_the_object_is_than_things_in_general() -> None:
    assert PRESENCE.evidence(1, so_likely(7.0)) == pytest.approx(TOLD)
    assert PRESENCE.evidence(1, so_likely(5.0)) == pytest.approx(TRUST)


def test_a_look_says_the_more_for_an_object_the_fewer_of_the_things_taught_resemble_it() -> None:
    assert PRESENCE.evidence(0, so_likely(100.0)) == pytest.approx(TRUST + np.log(2.0))
    many = usual_presence(15)
    assert many.evidence(3, so_likely(60.0)) == pytest.approx(TRUST + np.log(15.0), rel=0.01)
    supports = many.supports.copy()
    supports[3, 4:9] = supports[3, 3]
    alike = replace(many, supports=supports)
    assert alike.evidence(3, so_likely(60.0)) == pytest.approx(TRUST + np.log(15.0 / 6.0), rel=0.01)


def test_a_look_can_say_more_against_an_object_than_for_it() -> None:
    assert PRESENCE.evidence(0, so_likely(-100.0)) == -MOST_AGAINST


def test_parts_that_fall_short_speak_against_an_object_more_than_their_sum_does() -> None:
    own = Support(5.0, 10.0, 1.0, 4.0)
    short = own._replace(edges=9.0, depth=0.0)
    assert short.log_likelihood == own.log_likelihood == 20.0
    told = PRESENCE.evidence(0, own) - PRESENCE.evidence(0, short)
    assert told == pytest.approx(0.5 * PART_TEMPER * 4.0**2)
    assert PRESENCE.evidence(1, short) == PRESENCE.evidence(1, own)


def test_colours_that_had_to_be_learned_anew_speak_against_an_object() -> None:
    own, one_spread = Support(5.0, 10.0, 1.0, 4.0), 0.5 * RECOLOURED_SPREAD
    best = PRESENCE.evidence(0, own)
    anew = own._replace(recoloured=one_spread)
    assert PRESENCE.evidence(0, anew) == pytest.approx(best - 0.5)
    assert PRESENCE.evidence(0, own._replace(recoloured=-one_spread)) == best
    looks = Looks(PRESENCE)
    for frame, spreads in enumerate((0.0, 2.0) * 50):
        looks.add(frame * FRAME_NS, {0: own._replace(recoloured=spreads * one_spread)})
    assert looks.evidence(99 * FRAME_NS)[0] == pytest.approx(best - 0.5, abs=0.05)


def test_what_nobody_looked_for_is_told_neither_way() -> None:
    looks = Looks(PRESENCE)
    np.testing.assert_array_equal(looks.evidence(0), np.zeros(3))
    looks.add(0, {1: so_likely(7.0)})
    np.testing.assert_allclose(looks.evidence(0), [0.0, TOLD, 0.0])


def test_looks_that_say_the_same_do_not_add_up() -> None:
    looks = Looks(PRESENCE)
    for frame in range(100):
        looks.add(frame * FRAME_NS, {1: so_likely(7.0)})
    np.testing.assert_allclose(looks.evidence(99 * FRAME_NS), [0.0, TOLD, 0.0])


def test_one_look_that_errs_is_outvoted() -> None:
    looks = Looks(PRESENCE)
    for frame in range(20):
        looks.add(frame * FRAME_NS, {1: so_likely(8.0)})
    looks.add(20 * FRAME_NS, {1: so_likely(-18.0)})
    assert looks.evidence(20 * FRAME_NS)[1] > TRUST


def test_what_was_seen_long_ago_fades() -> None:
    looks = Looks(PRESENCE)
    looks.add(0, {1: so_likely(7.0)})
    assert 0.0 < looks.evidence(20_000_000_000)[1] < 0.01
    looks.restart()
    assert looks.evidence(0)[1] == 0.0
