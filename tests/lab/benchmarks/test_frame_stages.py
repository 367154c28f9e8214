import time

import pytest
from inhand_lab.benchmarks.frame_stages import PREPARE, SEARCH, STAGES, StageClock, stages_timed


def _work(seconds: float) -> None:
    end = time.process_time() + seconds
    while time.process_time() < end:
        pass


def test_time_is_booked_to_the_innermost_stage() -> None:
    clock = StageClock()
    prepare = clock.timed(PREPARE, _work)
    began = time.process_time_ns()
    with clock.running(SEARCH):
        _work(0.002)
        prepare(0.004)
        _work(0.002)
    whole = time.process_time_ns() - began
    booked = {stage: ns for stage, ns in clock.nanoseconds.items() if ns}
    assert set(booked) == {PREPARE, SEARCH}
    assert min(booked.values()) >= 4_000_000
    assert sum(booked.values()) <= whole


def test_the_time_of_what_fails_is_booked_and_the_stage_before_goes_on() -> None:
    clock = StageClock()

    def fail() -> None:
        raise ValueError("wild")

    with clock.running(SEARCH):
        with pytest.raises(ValueError, match="wild"):
            clock.timed(PREPARE, fail)()
        _work(0.001)
    assert clock.nanoseconds[SEARCH] >= 1_000_000


def test_every_timed_function_is_the_trackers_and_itself_again_afterwards() -> None:
    functions = [(holder, name) for stage in STAGES.values() for holder, name in stage]
    before = [getattr(holder, name) for holder, name in functions]
    with stages_timed():
        assert all(
            getattr(holder, name) is not usual
            for (holder, name), usual in zip(functions, before, strict=True)
        )
    assert [getattr(holder, name) for holder, name in functions] == before
