"""Interruptions: people who stop, or break off what they began and begin again."""

import numpy as np
import pytest
from inhand_lab.motions.interruptions import (
    Interruption,
    draw_interruptions,
    given_up_times,
    interrupted_times,
    place_interruptions,
)
from inhand_lab.motions.timeline import Stage

CLOCK = np.arange(0.0, 12.0, 0.01)
STOP = Interruption(after=0.5, stop=1.0, undone=False, slowing=0.25)
UNDO = Interruption(after=0.5, stop=1.0, undone=True, slowing=0.25)
STAGES = [
    Stage("wait", 0, 0.0, 3.0),
    Stage("lift", 0, 3.0, 4.0, breakable=True),
    Stage("swing", 0, 4.0, 6.0, swift=True),
    Stage("return", 0, 6.0, 6.6, breakable=True),
]


def test_time_runs_with_the_clock_where_nobody_stops() -> None:
    assert interrupted_times(CLOCK, []) == pytest.approx(CLOCK)


@pytest.mark.parametrize("interruption", [STOP, UNDO])
def test_a_stop_costs_what_it_says_and_the_rest_goes_on_as_before(
    interruption: Interruption,
) -> None:
    times = interrupted_times(CLOCK, [(3.0, interruption)])
    assert times[CLOCK < 3.3] == pytest.approx(CLOCK[CLOCK < 3.3])
    late = interruption.cost() + 3.7 < CLOCK
    assert times[late] == pytest.approx(CLOCK[late] - interruption.cost())


def test_nothing_goes_faster_than_before_and_an_undone_stage_goes_back_to_its_start() -> None:
    times = interrupted_times(CLOCK, [(3.0, UNDO), (6.0, STOP)])
    rates = np.diff(times) / 0.01
    assert np.abs(rates).max() < 1.0 + 1e-9
    assert np.abs(np.diff(rates)).max() < 0.1
    turn = int(np.argmin(rates))
    assert times[turn:].min() == pytest.approx(3.0, abs=1e-3)
    assert times[:turn].max() == pytest.approx(3.5, abs=1e-3)


def test_only_movements_that_can_be_stopped_are_interrupted_each_once() -> None:
    for seed in range(20):
        random = np.random.default_rng(seed)
        short = Interruption(after=0.3, stop=0.5, undone=False, slowing=0.25)
        assert [start for start, _ in place_interruptions(random, [STOP], STAGES)] == [3.0]
        placed = place_interruptions(random, [short, short, short], STAGES)
        assert [start for start, _ in placed] == [3.0, 6.0]


def test_interruptions_fit_into_the_time_there_is() -> None:
    for seed in range(20):
        drawn = draw_interruptions(np.random.default_rng(seed), spare=2.0)
        assert sum(interruption.cost() for interruption in drawn) <= 2.0


def test_who_gives_up_undoes_everything_and_began_nothing_swift() -> None:
    for seed in range(20):
        times = given_up_times(CLOCK, np.random.default_rng(seed), STAGES)
        rates = np.diff(times) / 0.01
        assert 2.0 < times.max() < 4.0
        assert np.abs(rates).max() < 1.0 + 1e-9
        assert np.abs(np.diff(rates)).max() < 0.1
        assert times[-1] == 0.0
