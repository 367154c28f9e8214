"""What goes on for longer than a window is one outcome with the whole amount."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from inhand_outcomes.achievement import Amount
from inhand_outcomes.lasting import LastingOutcomes
from inhand_outcomes.outcome import Outcome

S = 1_000_000_000
SETTLE_NS, PIECE_NS = 1.5 * S, 20.0 * S


def a_call(start_ns: int, end_ns: int) -> Outcome:
    """A call with what it lasted, and the angle at which the phone was held: its middle time."""
    amounts = {
        "duration_s": Amount((end_ns - start_ns) / S, 0.1),
        "angle_deg": Amount((start_ns + end_ns) / 2 / S, 1.0),
    }
    return Outcome(str(start_ns), "call", "phone", 0, start_ns, end_ns, 0.9, amounts, {})


def follow(calls: list[tuple[int, int]], until_ns: int, step_ns: int) -> list[Outcome]:
    """Measure calls again and again, each time what is not counted yet and has come."""
    lasting = LastingOutcomes(SETTLE_NS, PIECE_NS)
    outcomes = []
    for now_ns in range(step_ns, until_ns + step_ns, step_ns):
        found = [
            a_call(max(start, lasting.counted_ns), min(end, now_ns))
            for start, end in calls
            if start < now_ns and end > lasting.counted_ns
        ]
        outcomes += lasting.follow(found, now_ns, ended=now_ns >= until_ns)
    return outcomes


@given(
    start=st.integers(0, 100),
    seconds=st.integers(1, 300),
    step=st.sampled_from([0.5, 1.0, 3.0]),
)
def test_a_call_of_any_length_is_one_with_its_whole_duration(
    start: int, seconds: int, step: float
) -> None:
    end = start + seconds
    (call,) = follow([(start * S, end * S)], (end + 5) * S, round(step * S))
    assert (call.start_ns, call.end_ns) == (start * S, end * S)
    assert call.amounts["duration_s"].value == pytest.approx(seconds)
    assert call.amounts["angle_deg"].value == pytest.approx(start + seconds / 2)


@given(gap=st.integers(3, 60), first=st.integers(1, 90), second=st.integers(1, 90))
def test_two_calls_with_a_pause_are_two(gap: int, first: int, second: int) -> None:
    calls = [(0, first * S), ((first + gap) * S, (first + gap + second) * S)]
    outcomes = follow(calls, calls[1][1] + 5 * S, S)
    assert [(one.start_ns, one.end_ns) for one in outcomes] == calls


def test_a_call_under_way_is_said_when_its_track_ends() -> None:
    (call,) = follow([(0, 100 * S)], 50 * S, S)
    assert call.amounts["duration_s"].value == pytest.approx(50.0)
