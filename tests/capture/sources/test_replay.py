"""Recordings played as a camera."""

import math
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from inhand_capture.sources.replay import ReplaySource
from inhand_runtime.source import Captured, Pixels, SourceError
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
    return list(ReplaySource({"file": str(path), "rate": 0, **options}).captures(_wanted))


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


def test_a_reader_that_was_held_up_catches_up(recording: Path) -> None:
    played_frame_s = 10 * FRAME_NS / 1e9
    arrivals = []
    for _ in ReplaySource({"file": recording, "rate": 0.1}).captures(_wanted):
        arrivals.append(time.monotonic())
        if len(arrivals) == 1:
            time.sleep(6 * played_frame_s)
        if len(arrivals) == 6:
            break
    assert arrivals[5] - arrivals[1] < 2 * played_frame_s


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
