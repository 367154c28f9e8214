"""What time it is by the clock of captures, also while nothing is captured."""

import time

from inhand_outcomes.days import NS_PER_S


class CaptureClock:
    """Goes on from the last capture; before the first it is the host's clock.

    So a recording that is played as it was captured has its own time, and a host whose clock is
    set follows its cameras.
    """

    def __init__(self) -> None:
        self._ahead_ns = time.time_ns() - time.monotonic_ns()

    def hear(self, captured_ns: int, arrived_s: float | None = None) -> None:
        """Take the time of what was captured last, and came just now, or when the clock that nobody
        sets was at ``arrived_s``."""
        self._ahead_ns = captured_ns - _monotonic_ns(arrived_s)

    def now_ns(self, at_s: float | None = None) -> int:
        """The time now, or when the clock that nobody sets was at ``at_s``; nanoseconds since the
        epoch."""
        return _monotonic_ns(at_s) + self._ahead_ns


def _monotonic_ns(at_s: float | None) -> int:
    return time.monotonic_ns() if at_s is None else round(at_s * NS_PER_S)
