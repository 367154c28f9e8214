"""How often something happens, over the last seconds."""

from collections import deque

WINDOW_S = 3.0


class Rate:
    """Counts events, or follows a number that counts them, and says how many there are a second."""

    def __init__(self) -> None:
        self._events: deque[tuple[float, int]] = deque(maxlen=1024)
        self._count = 0

    def count(self, now: float) -> None:
        """Count an event at a time in seconds."""
        self._count += 1
        self._events.append((now, self._count))

    def at(self, now: float) -> float:
        """Return the events a second until a time."""
        while self._events and now - self._events[0][0] > WINDOW_S:
            self._events.popleft()
        return len(self._events) / WINDOW_S

    def of(self, number: int | None, now: float) -> float:
        """Note a growing number at a time, and return how fast it grows; 0 where it began anew."""
        while self._events and now - self._events[0][0] > WINDOW_S:
            self._events.popleft()
        if number is None:
            return 0.0
        if self._events and number < self._events[-1][1]:
            self._events.clear()
        self._events.append((now, number))
        began, first = self._events[0]
        return (number - first) / (now - began) if now > began else 0.0
