"""Spells by two limits: what cuts them, what does not, and how sure they are."""

import numpy as np
import pytest
from inhand_outcomes.measures.spells import find_spells, smoothed, sureness

TIMES = np.arange(100) / 10.0
NEVER = np.zeros(100, bool)


def between(start: float, end: float) -> np.ndarray:
    return (start - 0.01 <= TIMES) & (end + 0.01 >= TIMES)


def test_a_spell_reaches_as_far_as_the_looser_limit_and_halfway_to_the_next_frame() -> None:
    (spell,) = find_spells(TIMES, between(4, 5), between(3, 7), ~NEVER, 1.0)
    assert (spell.start_s, spell.end_s) == pytest.approx((2.95, 7.05))
    assert spell.begun
    assert spell.ended
    assert find_spells(TIMES, NEVER, between(3, 7), ~NEVER, 1.0) == []


def test_being_unseen_bridges_more_than_being_seen_elsewhere() -> None:
    there = between(2, 4) | between(5, 7)
    assert len(find_spells(TIMES, there, there, ~NEVER, 1.2)) == 2
    (whole,) = find_spells(TIMES, there, there, there | between(0, 1) | between(8, 9), 1.2)
    assert (whole.first, whole.last) == (20, 70)
    assert len(find_spells(TIMES, there, there, there, 0.8)) == 2
    glitch = between(2, 4) | between(4.5, 7)
    assert len(find_spells(TIMES, glitch, glitch, ~NEVER, 1.2)) == 1


def test_a_spell_that_is_hardly_seen_or_close_to_its_limit_is_less_sure() -> None:
    (spell,) = find_spells(TIMES, between(2, 8), between(2, 8), ~NEVER, 1.0)
    margins = np.full(100, 3.0)
    assert sureness(spell, ~NEVER, margins) == pytest.approx(0.99865, abs=1e-4)
    assert sureness(spell, ~NEVER, np.zeros(100)) == pytest.approx(0.5)
    assert sureness(spell, between(2, 3), margins) == pytest.approx(0.36, abs=0.01)
    assert sureness(spell, NEVER, margins) == 0.0


def test_an_average_is_of_what_was_seen_near_in_time() -> None:
    values = np.where(between(3, 4), 100.0, TIMES)
    mean = smoothed(TIMES, values, ~between(3, 4), 0.1)
    assert mean[60] == pytest.approx(6.0)
    assert np.isnan(mean[35])
    assert mean[28] < 3.0
