"""Times of the host's monotonic clock as times since the epoch."""

import time
from collections.abc import Callable

from inhand_capture.sources.oak.parameters import OAK


def epoch_offset(
    monotonic_ns: Callable[[], int] = time.monotonic_ns,
    epoch_ns: Callable[[], int] = time.time_ns,
) -> tuple[int, int]:
    """Return what to add to a monotonic time to get nanoseconds since the epoch, and its ±.

    The clocks cannot be read at once: of a few readings the one counts in which the monotonic clock
    went on the least meanwhile. It is asked for at each frame, since the calendar is set at times.
    """
    best: tuple[int, int] | None = None
    for _ in range(OAK.clock_readings):
        before, epoch, after = monotonic_ns(), epoch_ns(), monotonic_ns()
        uncertainty = (after - before + 1) // 2
        if best is None or uncertainty < best[1]:
            best = (epoch - (before + after) // 2, uncertainty)
        if after - before <= OAK.quick_reading_ns:
            break
    assert best is not None
    return best
