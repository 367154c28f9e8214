"""Durations and rates are by a clock that nobody set."""

from pathlib import Path

import pytest
from inhand_recorder.clock import CLOCK_RECORD, format_clock_steps
from inhand_recorder.inspection import RecordingInfo, inspect_recording
from inhand_recorder.reception import ReceptionTimes
from inhand_runtime.recording import RecordingWriter
from mcap.writer import Writer
from recordings import POSE_KEY, RGBD_KEY, START_NS, frame_messages

SECOND_NS = 10**9


def recorded(path: Path, step_s: float, noted: bool, after: int = 30) -> RecordingInfo:
    """What is in six seconds at 10 Hz, with the clock set after some of the messages."""
    step_ns = round(step_s * SECOND_NS)
    with RecordingWriter(path) as writer:
        for number in range(61):
            stamp_ns = START_NS + number * SECOND_NS // 10 + (step_ns if number > after else 0)
            for key, _, payload in frame_messages(number, 1)[:: 2 if number % 10 == 0 else 3]:
                stamps = {"received_ns": stamp_ns, "captured_ns": stamp_ns, "sequence": number}
                writer.write(key, payload, **stamps)
        if noted:
            seen_ns = START_NS + after * SECOND_NS // 10 + step_ns + SECOND_NS // 2
            writer.add_metadata(CLOCK_RECORD, format_clock_steps({seen_ns: step_ns}))
    return inspect_recording(path)


@pytest.mark.parametrize("step_s", [-3600.0, -0.5, -2.0, 0.4, 5.0, 3600.0])
def test_a_noted_step_is_taken_out_and_told(step_s: float, tmp_path: Path) -> None:
    info = recorded(tmp_path / "set.mcap", step_s, noted=True)
    assert info.duration_s == pytest.approx(6.0)
    rates = {key.key: key.rate_hz for key in info.keys}
    assert rates == {RGBD_KEY: pytest.approx(10.0), POSE_KEY: pytest.approx(1.0)}
    (line,) = info.clock
    assert line.startswith(f"the clock was set by {step_s:+.3f} s at ")
    assert line.endswith("duration and rates are without that")


@pytest.mark.parametrize("step_s", [-3600.0, -2.0])
def test_a_step_back_that_nobody_noted_is_taken_out_and_told(step_s: float, tmp_path: Path) -> None:
    info = recorded(tmp_path / "set.mcap", step_s, noted=False)
    assert info.duration_s == pytest.approx(6.0, abs=0.11)
    rates = {key.key: key.rate_hz for key in info.keys}
    assert rates == {
        RGBD_KEY: pytest.approx(10.0, rel=0.02),
        POSE_KEY: pytest.approx(1.0, rel=0.02),
    }
    (line,) = info.clock
    assert "goes back by" in line
    assert "no step of the clock is noted" in line


@pytest.mark.parametrize("step_s", [-3600.0, 3600.0])
def test_a_step_after_the_last_message_changes_nothing(step_s: float, tmp_path: Path) -> None:
    info = recorded(tmp_path / "set.mcap", step_s, noted=True, after=60)
    assert info.duration_s == pytest.approx(6.0)
    (line,) = info.clock
    assert "without that" not in line


def test_two_steps_are_taken_out_one_by_one() -> None:
    times = ReceptionTimes()
    steps = {START_NS - 57 * SECOND_NS: -60 * SECOND_NS, START_NS - 34 * SECOND_NS: 20 * SECOND_NS}
    for number in range(10):
        offset_s = 0 if number < 3 else -60 if number < 6 else -40
        times.add("a", START_NS + (number + offset_s) * SECOND_NS)
    spans, duration_s, lines = times.without_steps(steps)
    assert (duration_s, spans["a"].rate_hz, len(lines)) == (9.0, 1.0, 2)


def test_a_file_of_another_writer_need_not_be_in_order(tmp_path: Path) -> None:
    path = tmp_path / "foreign.mcap"
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        channel = writer.register_channel(POSE_KEY, "msgpack", 0)
        for number in (5, 0, 3, 1, 2, 4):
            payload = frame_messages(number, 1)[2][2]
            stamp_ns = START_NS + number * 10 * SECOND_NS
            writer.add_message(channel, stamp_ns, payload, stamp_ns, number)
        writer.finish()
    info = inspect_recording(path)
    assert (info.duration_s, info.keys[0].rate_hz, info.clock) == (50.0, 0.1, ())


def test_an_empty_recording_lasts_no_time() -> None:
    assert ReceptionTimes().without_steps({START_NS: -5}) == (
        {},
        0.0,
        ("the clock was set by -0.000 s at 2023-11-14T22:13:20.000+00:00",),
    )
