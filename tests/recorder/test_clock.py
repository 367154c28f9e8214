"""The wall clock may be set while a recorder runs: that is noted, and no fault of the file."""

from pathlib import Path

import pytest
from inhand_recorder.clock import CLOCK_RECORD, ClockWatch, format_clock_steps, parse_clock_steps
from inhand_recorder.verification import examine_recording
from inhand_runtime.recording import RecordingWriter
from recordings import POSE_KEY, START_NS, frame_messages

SECOND_NS = 10**9


def test_a_step_is_seen_once_with_its_size() -> None:
    wall, monotonic = [START_NS], [0]
    watch = ClockWatch(lambda: wall[0], lambda: monotonic[0])
    wall[0] += 5 * SECOND_NS
    monotonic[0] += 5 * SECOND_NS
    assert watch.step() is None
    wall[0] += SECOND_NS - 3600 * SECOND_NS
    monotonic[0] += SECOND_NS
    assert watch.step() == (wall[0], -3600 * SECOND_NS)
    assert watch.step() is None


def test_steps_are_read_as_they_are_written_and_damage_is_left_out() -> None:
    steps = {START_NS: -3, START_NS + 1: 4}
    assert parse_clock_steps(format_clock_steps(steps) | {"x": "1", "7": "y"}) == steps


@pytest.mark.parametrize("noted", [True, False])
def test_times_that_go_back_are_a_flaw_only_where_no_step_was_noted(
    tmp_path: Path, noted: bool
) -> None:
    with RecordingWriter(tmp_path / "set.mcap") as writer:
        for number in range(6):
            late_ns = 0 if number < 3 else -3600 * SECOND_NS
            writer.write(
                POSE_KEY,
                frame_messages(number, 1)[2][2],
                received_ns=START_NS + number * SECOND_NS + late_ns,
                captured_ns=START_NS + number * SECOND_NS,
                sequence=number,
            )
        if noted:
            steps = format_clock_steps({START_NS + 3 * SECOND_NS: -3600 * SECOND_NS})
            writer.add_metadata(CLOCK_RECORD, steps)
    examined = examine_recording(writer.path)
    assert bool(examined.problems) != noted
    assert any("the clock was set by -3600.000 s" in note for note in examined.notes) == noted
