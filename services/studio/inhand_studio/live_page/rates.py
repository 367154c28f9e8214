"""How often something happens, over the last seconds."""

from collections import deque
from collections.abc import Sequence

WINDOW_S = 3.0


class Rate:
    """Counts events, and says how many there are a second."""

    def __init__(self) -> None:
        self._events: deque[float] = deque(maxlen=1024)

    def count(self, now: float) -> None:
        """Count an event at a time in seconds."""
        self._events.append(now)

    def at(self, now: float) -> float:
        """Return the events a second until a time."""
        while self._events and now - self._events[0] > WINDOW_S:
            self._events.popleft()
        return len(self._events) / WINDOW_S


def rate_of(times: Sequence[float], now: float) -> float:
    """Return how often something happens that happened last at these times, in seconds."""
    if len(times) < 2 or now - times[-1] > WINDOW_S or times[-1] <= times[0]:
        return 0.0
    return (len(times) - 1) / (times[-1] - times[0])
