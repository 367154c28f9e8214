"""Times of the frames of recordings that tell their own."""

import logging
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from inhand_runtime.wording import counted
from inhand_tracker.geometry.arrays import Indices

from inhand_lab.datasets.dataset import START_NS, DatasetError
from inhand_lab.datasets.recording_times import check_times
from inhand_lab.importers.parameters import DEFAULT_IMPORT

log = logging.getLogger(__name__)

_LATEST_NS = 2**62
"""Time in nanoseconds, in the year 2116, that no recording is after."""


def times_since_start(path: Path, times_ns: Sequence[int], clock: str) -> Indices:
    """Return times (T,) that count from any moment as if the first were ``START_NS``.

    Raises DatasetError as ``checked_times`` does.
    """
    first = times_ns[0] if times_ns else 0
    return checked_times(path, [START_NS + time - first for time in times_ns], clock)


def checked_times(path: Path, times_ns: Sequence[int], clock: str) -> Indices:
    """Return times (T,) of frames in nanoseconds since the epoch.

    ``clock`` names where the file has them, and their unit. Raises DatasetError for times that no
    clock shows: out of range, in another unit, or backwards.
    """
    if not all(0 <= time < _LATEST_NS for time in times_ns):
        raise DatasetError(f"{path}: times are out of range; they are {clock}")
    times = np.array(times_ns, np.int64)
    steps_s = np.diff(times) / 1e9
    for frame in np.flatnonzero(steps_s < 0.0)[:1]:
        raise DatasetError(
            f"{path}: the clock steps back by {-steps_s[frame]:.3g} s at frame {frame + 1}: cut "
            "the file in two there"
        )
    if len(steps_s) and np.median(steps_s) > DEFAULT_IMPORT.slowest_s:
        raise DatasetError(
            f"{path}: frames are {np.median(steps_s):.3g} s apart, in the median: times should be "
            f"{clock}"
        )
    check_times(path, times)
    return times


def frames_at_rate(path: Path, times_ns: Indices, rate: float) -> Indices:
    """Return the indices of frames to keep, so that there are about ``rate`` a second.

    Frames too soon after one that is kept are left out; a recording slower than ``rate`` is kept
    whole. Frames of the same time as the one before are repetitions, and warned of.
    """
    repeated = int((np.diff(times_ns) == 0).sum())
    if repeated:
        log.warning(
            "%s: %s of the time of the one before; left out",
            path,
            counted(repeated, "frame is", "frames are"),
        )
    closest_ns = DEFAULT_IMPORT.closest_share * 1e9 / rate
    kept: list[int] = []
    for frame, time_ns in enumerate(times_ns.tolist()):
        apart_ns = time_ns - times_ns[kept[-1]] if kept else np.inf
        if apart_ns > 0 and apart_ns >= closest_ns:
            kept.append(frame)
    return np.array(kept, int)
