"""What time it is by the clock of captures, also while nothing is captured."""

import time


class CaptureClock:
    """Goes on from the last capture; before the first it is the host's clock.

    So a recording that is played as it was captured has its own time, and a host whose clock is
    set follows its cameras.
    """

    def __init__(self) -> None:
        self._ahead_ns = time.time_ns() - time.monotonic_ns()

    def hear(self, captured_ns: int) -> None:
        """Take the time of what was captured last."""
        self._ahead_ns = captured_ns - time.monotonic_ns()

    def now_ns(self) -> int:
        """The time now, nanoseconds since the epoch."""
        return time.monotonic_ns() + self._ahead_ns
