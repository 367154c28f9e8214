"""Recordings played as a camera."""

import math
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec
import pytest
from inhand_capture.sources.replay import ReplaySource
from inhand_capture.sources.replay_playback import LONGEST_DELAY_S
from inhand_runtime.recording import RecordingWriter
from inhand_runtime.source import Captured, Pixels, SourceError
from inhand_schemas.keys import Site
from inhand_schemas.topics import INFO, LABEL, RGBD, SKELETONS, AnyTopic
from played import (
    CAMERA_INFO,
    DEPTH,
    FRAME_NS,
    PICTURE,
    START_NS,
    entries,
    frame_entries,
    write,
)
from scripted_source import PERSON


def _wanted() -> bool:
    return True


def _play(path: Path, **options: Any) -> list[Captured]:
    played = ReplaySource({"file": str(path), "rate": 0, **options}).captures(_wanted)
    return [captured for captured in played if captured is not None]


def _times(captured: list[Captured]) -> list[int]:
    return [(each.time_ns - START_NS) // FRAME_NS for each in captured]


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    """Ten frames of one camera."""
    return write(tmp_path / "ten.mcap", entries(10))


def test_every_frame_comes_back_with_all_that_belongs_to_it(recording: Path) -> None:
    captured = _play(recording)
    assert _times(captured) == list(range(10))
    for each in captured:
        assert each.people == (PERSON,)
        assert each.convention == "kinect_v2"
        assert [label.object for label in each.labels] == ["mug"]
        assert each.time_uncertainty_ns == 7


def test_pictures_pass_untouched(recording: Path) -> None:
    pixels = _play(recording)[0].pixels
    assert pixels is not None
    assert pixels() == Pixels(PICTURE, DEPTH)


def test_the_recorded_info_is_the_cameras(recording: Path) -> None:
    assert ReplaySource({"file": recording}).info == CAMERA_INFO


@pytest.mark.parametrize(
    ("missing", "has_pixels", "has_people", "has_labels"),
    [(RGBD, False, True, True), (SKELETONS, True, False, True), (LABEL, True, True, False)],
)
def test_a_recording_without_a_stream_plays_the_others(
    tmp_path: Path, missing: AnyTopic, has_pixels: bool, has_people: bool, has_labels: bool
) -> None:
    captured = _play(write(tmp_path / "some.mcap", entries(3, without=(missing,))))
    assert _times(captured) == [0, 1, 2]
    for each in captured:
        assert (each.pixels is not None) == has_pixels
        assert (each.people is not None) == has_people
        assert bool(each.labels) == has_labels


def test_messages_received_out_of_order_are_put_together(tmp_path: Path) -> None:
    skeletons, frames = entries(20, without=(RGBD,)), entries(20, without=(SKELETONS, LABEL, INFO))
    late = 6
    mixed = skeletons[: 2 * late + 1]
    for number, frame in enumerate(frames):
        mixed += [frame, *skeletons[2 * (number + late) + 1 : 2 * (number + late) + 3]]
    captured = _play(write(tmp_path / "mixed.mcap", mixed))
    assert _times(captured) == list(range(20))
    assert all(each.pixels and each.people and each.labels for each in captured)


def test_a_frame_that_was_lost_in_the_recording_is_passed_over(tmp_path: Path) -> None:
    kept = [entry for entry in entries(5) if (entry[0], entry[2].sequence) != (RGBD, 102)]
    captured = _play(write(tmp_path / "lost.mcap", kept))
    assert [each.pixels is not None for each in captured] == [True, True, False, True, True]


def test_frames_come_with_their_original_timing(recording: Path) -> None:
    source = ReplaySource({"file": recording})
    times = [(time.monotonic(), each.time_ns) for each in source.captures(_wanted)]
    for (now, _), number in zip(times, range(10), strict=True):
        assert now - times[0][0] >= number * FRAME_NS / 1e9 - 1e-3


def test_a_rate_of_two_takes_half_the_time(recording: Path) -> None:
    begin = time.monotonic()
    list(ReplaySource({"file": recording, "rate": "2"}).captures(_wanted))
    took = time.monotonic() - begin
    assert took >= 9 * FRAME_NS / 2e9 - 1e-3


def _arrivals_after_a_pause(recording: Path, pause_s: float) -> list[float]:
    arrivals = []
    for captured in ReplaySource({"file": recording, "rate": 0.2}).captures(_wanted):
        if captured is not None:
            arrivals.append(time.monotonic())
            if len(arrivals) == 1:
                time.sleep(pause_s)
    return arrivals


PLAYED_FRAME_S = 5 * FRAME_NS / 1e9


def test_a_reader_that_was_held_up_a_moment_catches_up(recording: Path) -> None:
    arrivals = _arrivals_after_a_pause(recording, 0.9 * LONGEST_DELAY_S)
    assert arrivals[4] - arrivals[1] < 2 * PLAYED_FRAME_S


def test_after_a_pause_playback_goes_on_from_now_and_sends_no_burst(recording: Path) -> None:
    arrivals = _arrivals_after_a_pause(recording, LONGEST_DELAY_S + 5 * PLAYED_FRAME_S)
    assert arrivals[5] - arrivals[1] > 3 * PLAYED_FRAME_S


@pytest.mark.parametrize("step_s", [3600, -3600])
def test_a_clock_that_was_set_is_told_and_played_over_in_the_files_order(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, step_s: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("inhand_capture.sources.replay.LONGEST_STEP_S", 0.5)
    path = tmp_path / "set.mcap"
    with RecordingWriter(path) as writer:
        for topic, name, message in entries(10):
            late = step_s * 10**9 if message.sequence >= 105 else 0
            stamped = msgspec.structs.replace(message, time_ns=message.time_ns + late)
            writer.write(
                topic.key(Site(), name),
                topic.encode(stamped),
                received_ns=stamped.time_ns,
                captured_ns=stamped.time_ns,
                sequence=stamped.sequence,
            )
    begin = time.monotonic()
    captured = [one for one in ReplaySource({"file": path}).captures(_wanted) if one is not None]
    assert time.monotonic() - begin < 2.0
    steps = [0] * 5 + [step_s * 10**9] * 5
    assert [one.time_ns for one in captured] == [
        START_NS + number * FRAME_NS + step for number, step in enumerate(steps)
    ]
    assert caplog.text.count("the recorded time jumps by") == 1


def test_a_long_wait_gives_signs_of_life(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("inhand_capture.sources.replay_playback.QUIET_S", 0.02)
    played = list(
        ReplaySource({"file": write(tmp_path / "slow.mcap", entries(2)), "rate": 0.1}).captures(
            _wanted
        )
    )
    assert sum(each is None for each in played) >= 3
    assert sum(each is not None for each in played) == 2


def test_a_loop_begins_again_with_the_original_times(recording: Path) -> None:
    source = ReplaySource({"file": recording, "rate": 0, "loop": True})
    playing = source.captures(_wanted)
    captured = [next(playing) for _ in range(25)]
    assert _times(captured) == [*range(10), *range(10), *range(5)]
    source.close()
    assert list(playing) == []


def test_closing_ends_a_wait_for_the_next_frame(tmp_path: Path) -> None:
    far = [*entries(1), *frame_entries(10_000)]
    source = ReplaySource({"file": write(tmp_path / "far.mcap", far)})
    playing = source.captures(_wanted)
    next(playing)
    source.close()
    assert list(playing) == []


def test_one_camera_of_several_is_chosen_by_name(tmp_path: Path) -> None:
    both = [*entries(3, camera="left"), *entries(3, camera="right")]
    path = write(tmp_path / "both.mcap", both)
    captured = _play(path, camera="right")
    assert _times(captured) == [0, 1, 2]
    assert {label.camera for each in captured for label in each.labels} == {"right"}
    with pytest.raises(SourceError, match=r"set options\.camera to one of: left, right"):
        ReplaySource({"file": path})
    with pytest.raises(SourceError, match="no camera 'top'; there are: left, right"):
        ReplaySource({"file": path, "camera": "top"})


def _cut(path: Path) -> None:
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def _replace(path: Path) -> None:
    path.write_bytes(b"a letter to my aunt")


@pytest.mark.parametrize(
    ("damage", "line"),
    [
        (Path.unlink, "does not exist: check the path"),
        (_replace, "is no recording: give a .mcap file"),
        (_cut, "was cut off: `inhand recording recover"),
    ],
)
def test_a_file_that_cannot_be_played_is_told_in_one_line(
    recording: Path, damage: Callable[[Path], None], line: str
) -> None:
    damage(recording)
    with pytest.raises(SourceError) as refused:
        ReplaySource({"file": recording})
    assert str(refused.value).startswith(f"{recording} {line}")
    assert "\n" not in str(refused.value)


def test_a_recording_without_a_camera_is_refused(tmp_path: Path) -> None:
    path = write(tmp_path / "blind.mcap", entries(2, without=(INFO,)))
    with pytest.raises(SourceError, match="holds no camera's info"):
        ReplaySource({"file": path})


@pytest.mark.parametrize(
    ("options", "line"),
    [
        ({}, "setting options.file is missing"),
        ({"file": "x", "rat": 1}, r"unknown setting options.rat \(did you mean rate\?\)"),
        ({"file": "x", "rate": -1}, "setting options.rate: .*greater than or equal to 0"),
        ({"file": "x", "rate": math.inf}, "setting options.rate: .*finite"),
    ],
)
def test_wrong_options_are_told(options: dict[str, Any], line: str) -> None:
    with pytest.raises(SourceError, match=line):
        ReplaySource(options)
