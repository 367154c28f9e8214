"""Times that are no clock's are refused, and the frame rate is what times show."""

from pathlib import Path

import numpy as np
import pytest
from changed_recordings import with_times, write_recording
from inhand_lab.datasets.dataset import DatasetEntry, DatasetError
from inhand_lab.datasets.recorded_frames import load_frames
from inhand_lab.datasets.recording_times import frame_rate_of
from inhand_lab.datasets.tracks import true_track
from waving import FRAME_NS, START_NS

WRONG = {
    "seconds": (
        lambda t, _: t // 10**9,
        "all 30 frames have the same time_ns, 1000000000: write",
    ),
    "milliseconds": (lambda t, _: t // 10**6, "within 966 ns by their time_ns: it is in milliseco"),
    "microseconds": (
        lambda t, _: t // 10**3,
        "within 966666 ns .*it is in microseconds; write nan",
    ),
    "whole seconds": (lambda t, _: t // 10**9 * 10**9, "all 30 frames have the same time_ns"),
    "one time": (lambda t, _: 10**18, "all 30 frames have the same time_ns, 1000000000000000000"),
    "one time but one": (
        lambda t, n: 10**18 + (n == 29) * 10**9,
        "28 have that of the frame befor",
    ),
    "backwards": (lambda t, n: START_NS - n * FRAME_NS, "runs backwards at 29 of 30 frames, first"),
    "one frame early": (
        lambda t, n: 5 if n == 7 else t,
        "time_ns of frame 7 is 5, and those beside it are 1",
    ),
    "one frame late": (
        lambda t, n: t + (n == 7) * 10**12,
        "time_ns of frame 7 is 1000001000233333331, and th",
    ),
}


def test_five_seconds_in_five_nanoseconds_are_seconds(tmp_path: Path) -> None:
    path = write_recording(tmp_path / "a.mcap", with_times(lambda t, _: t // 10**9), 150)
    with pytest.raises(DatasetError, match=r"150 frames lie within 4 ns .*it is in seconds; write"):
        load_frames(path, "box")


@pytest.mark.parametrize("what", WRONG)
def test_times_that_are_no_clocks_are_refused_in_one_line(what: str, tmp_path: Path) -> None:
    change, message = WRONG[what]
    path = write_recording(tmp_path / "a.mcap", with_times(change))
    with pytest.raises(DatasetError, match=message) as caught:
        load_frames(path, "box")
    assert str(caught.value).startswith(str(path))
    assert "\n" not in str(caught.value)


def test_one_frame_of_another_unit_among_many_is_named(tmp_path: Path) -> None:
    change = with_times(lambda t, n: t // 10**6 if n == 70 else t)
    path = write_recording(tmp_path / "a.mcap", change, 150)
    with pytest.raises(DatasetError, match=r"time_ns of frame 70 is 1000000002333, and those"):
        load_frames(path, "box")


def test_a_clock_may_be_set_and_begin_anywhere(tmp_path: Path) -> None:
    for begin, set_back in ((0, 0), (START_NS, 2 * 10**8), (2 * START_NS, 10**15)):
        change = with_times(
            lambda t, n, begin=begin, back=set_back: t - START_NS + begin - (n >= 75) * back
        )
        frames = load_frames(write_recording(tmp_path / f"{begin}.mcap", change, 150), "box")
        assert np.isfinite(true_track(frames).translations).all()


def entry(frame_rate: float | None) -> DatasetEntry:
    return DatasetEntry(file="a.mcap", interaction="w", participant="p", frame_rate=frame_rate)


def times(rate: float, frames: int = 300) -> np.ndarray:
    return START_NS + np.round(np.arange(frames) * 1e9 / rate).astype(np.int64)


@pytest.mark.parametrize("rate", [15.0, 24.0, 30.0, 60.0, 240.0])
def test_a_rate_that_is_left_out_comes_from_the_times(rate: float) -> None:
    assert frame_rate_of(entry(None), times(rate)) == pytest.approx(rate, rel=1e-3)
    assert frame_rate_of(entry(rate), times(rate)) == rate


@pytest.mark.parametrize("rate", [15.0, 25.0, 60.0])
def test_a_rate_that_the_times_contradict_is_refused_with_the_right_one(rate: float) -> None:
    with pytest.raises(DatasetError, match=rf"frame_rate = 30: write frame_rate = {rate:g}, or"):
        frame_rate_of(entry(30.0), times(rate))


def test_lost_frames_gaps_and_whole_milliseconds_contradict_no_rate() -> None:
    exact = times(30.0)
    lost = np.delete(exact, np.arange(0, 300, 4))
    gap = exact + 10**11 * (np.arange(300) > 150)
    for stamps in (lost, gap, exact // 10**6 * 10**6, exact[:1]):
        assert frame_rate_of(entry(30.0), stamps) == 30.0
    assert frame_rate_of(entry(None), gap) == pytest.approx(30.0, rel=1e-3)
    assert frame_rate_of(entry(None), exact[:1]) == 30.0
