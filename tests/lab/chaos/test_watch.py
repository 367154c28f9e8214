"""How a stream comes back after a fault, by numbers that are worked out by hand."""

from pathlib import Path

import numpy as np
from inhand_lab.chaos.host import HostClock
from inhand_lab.chaos.watch import Arrivals, recovery_of

BEGIN, END, UNTIL = 100.0, 104.0, 112.0
USUAL_AGE_S = 0.010


def arrivals(times: np.ndarray, ages: np.ndarray | float = USUAL_AGE_S) -> Arrivals:
    """Messages that came at these times (N,), so old."""
    return Arrivals(times - ages, times, times - ages)


def every_tenth(start: float, end: float) -> np.ndarray:
    """Ten times a second from ``start`` to before ``end``."""
    return start + 0.1 * np.arange(round((end - start) * 10))


def test_a_stream_that_never_stops_is_back_with_its_next_message() -> None:
    recovery = recovery_of(arrivals(every_tenth(90.05, UNTIL)), BEGIN, END, UNTIL)
    assert np.isclose(recovery.silent_s, 0.1)
    assert recovery.back_s is not None
    assert np.isclose(recovery.back_s, 0.05)
    assert recovery.normal_s == recovery.back_s


def test_silence_is_measured_to_the_first_message_after_it() -> None:
    times = np.concatenate((every_tenth(90.0, 100.95), every_tenth(106.5, UNTIL)))
    recovery = recovery_of(arrivals(times), BEGIN, END, UNTIL)
    assert np.isclose(recovery.silent_s, 106.5 - 100.9)
    assert recovery.back_s is not None
    assert np.isclose(recovery.back_s, 2.5)
    assert recovery.normal_s == recovery.back_s


def test_what_was_captured_before_the_cause_ended_brings_nothing_back() -> None:
    came = np.linspace(104.1, 104.2, 30)
    backlog = arrivals(came, came - np.linspace(101.0, 103.9, 30))
    usual = arrivals(every_tenth(90.0, 100.0))
    times = np.concatenate((usual.came, backlog.came))
    seen = arrivals(times, times - np.concatenate((usual.captured, backlog.captured)))
    recovery = recovery_of(seen, BEGIN, END, UNTIL)
    assert recovery.back_s is None
    assert recovery.normal_s is None


def test_poses_are_as_usual_again_from_the_last_second_in_which_they_were_old() -> None:
    times = every_tenth(90.0, UNTIL)
    ages = np.where((times > 100.0) & (times < 106.0), 0.5, USUAL_AGE_S)
    recovery = recovery_of(arrivals(times, ages), BEGIN, END, UNTIL)
    assert recovery.normal_s == 2.0


def test_poses_that_stay_old_are_never_as_usual() -> None:
    times = every_tenth(90.0, UNTIL)
    recovery = recovery_of(
        arrivals(times, np.where(times > 100.0, 0.5, USUAL_AGE_S)), BEGIN, END, UNTIL
    )
    assert recovery.back_s is not None
    assert recovery.normal_s is None


def test_where_nothing_comes_the_silence_lasts_to_the_end() -> None:
    recovery = recovery_of(arrivals(every_tenth(90.0, 100.0)), BEGIN, END, UNTIL)
    assert recovery.silent_s == UNTIL - BEGIN
    assert recovery.back_s is None


def test_a_clock_that_was_set_makes_nothing_look_older_or_newer(tmp_path: Path) -> None:
    clock = HostClock(tmp_path / "clock")
    came = np.array([100.0, 101.0, 102.0])
    assert clock.true_times(came - 0.01, came).tolist() == (came - 0.01).tolist()
    clock.step(3600.0)
    clock.step(-3601.0)
    stamps = came - 0.01 + np.array([0.0, 3600.0, -1.0])
    assert np.allclose(clock.true_times(stamps, came), came - 0.01)
