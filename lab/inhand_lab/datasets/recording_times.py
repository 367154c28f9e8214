"""Checks the times of a recording's frames, says how many of them there are a second, and finds
the frame that a message is of."""

from collections.abc import Sequence
from pathlib import Path
from typing import Protocol

import numpy as np
from inhand_tracker.geometry.arrays import Array, Indices

from inhand_lab.datasets.dataset import DatasetEntry, DatasetError
from inhand_lab.datasets.parameters import DEFAULT_DATASET

_UNITS_NS = {"seconds": 10**9, "milliseconds": 10**6, "microseconds": 10**3}


class Stamped(Protocol):
    """Anything with the number and the time of a frame."""

    @property
    def sequence(self) -> int:
        """The frame's number."""

    @property
    def time_ns(self) -> int:
        """When the frame was taken, in nanoseconds."""


class FrameNumbers:
    """Finds which of some frames a message is of: other programs round times."""

    def __init__(self, frames: Sequence[Stamped]) -> None:
        self._times_ns = [frame.time_ns for frame in frames]
        self._by_sequence: dict[int, list[int]] = {}
        for number, frame in enumerate(frames):
            self._by_sequence.setdefault(frame.sequence, []).append(number)
        steps = np.diff(self._times_ns)
        steps = steps[steps > 0]
        self._half_frame_ns = 0.5 * float(np.median(steps)) if len(steps) else 0.0

    def nearest(self, message: Stamped) -> int | None:
        """Return the number of the frame that has a message's ``sequence`` and a time less than
        half a frame away; None where there is none."""
        same = self._by_sequence.get(message.sequence, [])
        number = min(same, key=lambda one: self.apart_ns(one, message), default=None)
        if number is not None and self.apart_ns(number, message) <= self._half_frame_ns:
            return number
        return None

    def apart_ns(self, number: int, message: Stamped) -> int:
        """Return how many nanoseconds a frame and a message are apart."""
        return abs(self._times_ns[number] - message.time_ns)


def check_times(path: Path, times_ns: Indices) -> None:
    """Check the times (T,) of frames in their order; raises DatasetError for what is no clock's.

    A few steps back are accepted: a clock may be set while it is recorded.
    """
    if len(times_ns) < 2:
        return
    steps = np.diff(times_ns)
    if len(times_ns) >= DEFAULT_DATASET.fewest_timed:
        _check_unit(path, times_ns, steps)
    for frame in _out_of_line(times_ns)[:1]:
        raise DatasetError(
            f"{path}: time_ns of frame {frame} is {times_ns[frame]}, and those beside it are "
            f"{times_ns[frame - 1]} and {times_ns[frame + 1]}: write when it was taken, in "
            "nanoseconds"
        )
    backwards = np.flatnonzero(steps < 0)
    if len(backwards) > DEFAULT_DATASET.most_backwards_share * len(steps):
        first = int(backwards[0])
        raise DatasetError(
            f"{path}: time_ns runs backwards at {len(backwards)} of {len(times_ns)} frames, first "
            f"by {-steps[first] / 1e9:g} s at frame {first + 1}: write when each frame was taken, "
            "in nanoseconds"
        )


def frame_rate_of(entry: DatasetEntry, times_ns: Indices) -> float:
    """Return the frames a second of a recording with these times (T,).

    It is what ``dataset.toml`` says, or what the times show where that says nothing. Raises
    DatasetError where the two disagree.
    """
    steps_s = np.diff(times_ns) / 1e9
    steps_s = steps_s[steps_s > 0]
    if len(steps_s) == 0:
        return entry.frame_rate or DEFAULT_DATASET.usual_rate_hz
    measured = _measured_rate(steps_s)
    if entry.frame_rate is None:
        return measured
    # Lost frames change the mean, not the median; stamps that come in pairs do the opposite.
    for rate in (measured, 1.0 / float(np.median(steps_s))):
        if abs(entry.frame_rate / rate - 1.0) <= DEFAULT_DATASET.same_rate_share:
            return entry.frame_rate
    raise DatasetError(
        f"{entry.file} has {measured:.3g} frames a second by its time_ns, and dataset.toml says "
        f"frame_rate = {entry.frame_rate:g}: write frame_rate = {measured:.3g}, or leave it out"
    )


def _measured_rate(steps_s: Array) -> float:
    """Return the number of frames a second, to four digits, gaps left out."""
    median = float(np.median(steps_s))
    steady = steps_s[steps_s <= max(DEFAULT_DATASET.gap_s, 2.0 * median)]
    return float(f"{1.0 / steady.mean():.4g}")


def _check_unit(path: Path, times_ns: Indices, steps: Indices) -> None:
    """Raise DatasetError for times that are all but the same in nanoseconds."""
    frames, span_ns = len(times_ns), int(times_ns.max() - times_ns.min())
    if span_ns == 0:
        raise DatasetError(
            f"{path}: all {frames} frames have the same time_ns, {times_ns[0]}: write when each "
            "was taken, in nanoseconds"
        )
    usual_ns = float(np.median(np.abs(steps)))
    if usual_ns * DEFAULT_DATASET.fastest_hz >= 1e9:
        return
    told = f"{path}: {frames} frames lie within {_duration(span_ns)} by their time_ns"
    for name, unit_ns in _UNITS_NS.items():
        if 1.0 <= frames * 1e9 / (span_ns * unit_ns) <= DEFAULT_DATASET.fastest_hz:
            raise DatasetError(f"{told}: it is in {name}; write nanoseconds")
    same = int((steps == 0).sum())
    raise DatasetError(
        f"{told}, and {same} have that of the frame before: write when each was taken, in "
        "nanoseconds"
    )


def _out_of_line(times_ns: Indices) -> Indices:
    """Return the frames that lie far outside the times of both neighbours, which are in order."""
    before, time, after = times_ns[:-2], times_ns[1:-1], times_ns[2:]
    farthest = DEFAULT_DATASET.farthest_out_ns
    outside = (time < before - farthest) | (time > after + farthest)
    return np.flatnonzero((before <= after) & outside) + 1


def _duration(span_ns: int) -> str:
    return f"{span_ns} ns" if span_ns < 10**6 else f"{span_ns / 1e9:g} s"
