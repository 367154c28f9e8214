"""A camera's period, by when its messages arrive."""

import pytest
from inhand_tracker.live.arrivals import Arrivals
from inhand_tracker.live.parameters import DEFAULT_MOMENTS


def measured(*times: float) -> float:
    arrivals = Arrivals()
    for time in times:
        arrivals.add(time)
    return arrivals.period_s


@pytest.mark.parametrize("period_s", [0.011, 1.0 / 30.0, 0.2])
def test_the_period_is_the_mean_interval_also_of_what_comes_in_bursts(period_s: float) -> None:
    count = DEFAULT_MOMENTS.intervals + 1
    assert measured(*(n * period_s for n in range(count))) == pytest.approx(period_s)
    bursts = (3 * (n // 3) * period_s for n in range(3 * count))
    assert measured(*bursts) == pytest.approx(period_s, rel=0.11)


def test_a_period_that_is_not_known_yet_is_that_of_a_usual_camera() -> None:
    assert measured() == measured(1.0) == measured(1.0, 1.001) == DEFAULT_MOMENTS.first_period_s


def test_a_pause_does_not_count_and_what_follows_is_measured_anew() -> None:
    fast, slow = (n * 0.01 for n in range(40)), (100.0 + n * 0.1 for n in range(20))
    assert measured(*fast, *slow) == pytest.approx(0.1)


def test_a_period_is_never_nothing() -> None:
    assert measured(*[5.0] * 40) > 0.0
