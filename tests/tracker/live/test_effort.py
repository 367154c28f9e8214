"""The effort comes to rest where steps fit into the period, whatever a step costs."""

from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st
from inhand_tracker.live.effort import Effort, after_step
from inhand_tracker.live.parameters import DEFAULT_EFFORT

PERIOD_S = 1.0 / 30.0
LEAST, MOST = DEFAULT_EFFORT.least_load, DEFAULT_EFFORT.most_load
DECISIONS = 60

costs = st.floats(0.0, 3.0)
"""Parts of a step, in periods."""


def decisions(
    fixed: float, by_effort: float, start: float = 1.0, noise: tuple[float, ...] = (1.0,)
) -> list[float]:
    """The efforts after each decision, where a step costs ``fixed + by_effort * effort``."""
    effort, shares = Effort(start), [start]
    for number in range(DECISIONS * DEFAULT_EFFORT.steps):
        load = (fixed + by_effort * effort.share) * noise[number % len(noise)]
        effort = after_step(effort, load * PERIOD_S, PERIOD_S)
        if not effort.loads:
            shares.append(effort.share)
    return shares


@given(costs, costs, st.floats(DEFAULT_EFFORT.least, 1.0))
def test_the_effort_never_turns_round_and_comes_to_rest_where_steps_fit(
    fixed: float, by_effort: float, start: float
) -> None:
    shares = decisions(fixed, by_effort, start)
    changes = [after - before for before, after in pairwise(shares)]
    assert all(change >= 0.0 for change in changes) or all(change <= 0.0 for change in changes)
    assert shares[-1] == shares[-20]
    load = fixed + by_effort * shares[-1]
    assert load <= MOST or shares[-1] == DEFAULT_EFFORT.least
    assert load >= LEAST or shares[-1] == 1.0


@given(costs, costs)
def test_a_load_that_falls_brings_the_whole_effort_back(fixed: float, by_effort: float) -> None:
    low = decisions(fixed, by_effort)[-1]
    assert decisions(0.1, 0.3, low)[-1] == 1.0


@given(costs, costs, st.lists(st.floats(0.9, 1.1), min_size=1, max_size=97).map(tuple))
def test_steps_that_vary_by_a_tenth_do_not_make_it_swing(
    fixed: float, by_effort: float, noise: tuple[float, ...]
) -> None:
    shares = decisions(fixed, by_effort, noise=noise)
    assert len(set(shares[20:])) <= 3
    assert shares[20:] in (sorted(shares[20:]), sorted(shares[20:], reverse=True))


def test_single_slow_steps_change_nothing() -> None:
    noise = (1.0,) * 6 + (30.0,)
    assert set(decisions(0.2, 0.4, noise=noise)) == {1.0}


def test_an_overload_is_met_within_two_decisions_where_work_follows_the_effort() -> None:
    assert 0.0 + 2.5 * decisions(0.0, 2.5)[1] <= MOST
    assert 0.2 + 2.0 * decisions(0.2, 2.0)[2] <= MOST


def test_steps_that_are_longer_than_the_period_are_met_at_once() -> None:
    effort = Effort()
    for _ in range(DEFAULT_EFFORT.late_steps):
        assert effort.share == 1.0
        effort = after_step(effort, 1.2 * PERIOD_S, PERIOD_S)
    assert 1.2 * effort.share <= MOST
