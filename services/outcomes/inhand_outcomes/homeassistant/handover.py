"""What passes between the daemon's loop and the thread that talks to Home Assistant.

Neither ever waits for the other: there is one place for the newest state, and few for events.
"""

import threading
import time
from collections import deque
from collections.abc import Callable, Iterable
from datetime import date

from inhand_outcomes.homeassistant.parameters import DEFAULT_HOME, HomeParameters
from inhand_outcomes.homeassistant.shape import Shape
from inhand_outcomes.homeassistant.state import HomeEvent, HomeState


class Handover:
    """The newest state and the events to be sent."""

    def __init__(self, parameters: HomeParameters = DEFAULT_HOME) -> None:
        self._lock = threading.Lock()
        self._state: HomeState | None = None
        self._old: tuple[Shape, ...] = ()
        self._events: deque[tuple[float, HomeEvent]] = deque(maxlen=parameters.events)
        self._events_last_s = parameters.events_last_s
        self._announced: Shape | None = None
        self._wake: Callable[[], object] = lambda: None

    def show(self, state: HomeState, old: tuple[Shape, ...]) -> None:
        """Take the newest state, in place of one that was not sent yet; ``old`` are all shapes of
        which something may still be retained."""
        with self._lock:
            self._state, self._old = state, old
        self._wake()

    def say(self, events: Iterable[HomeEvent]) -> None:
        """Take events, which are sent if they can be sent soon."""
        now_s = time.monotonic()
        with self._lock:
            self._events.extend((now_s, event) for event in events)
        self._wake()

    def take_announced(self) -> Shape | None:
        """Return the shape that is all that is retained now, once."""
        with self._lock:
            announced, self._announced = self._announced, None
        return announced

    # For the thread:

    def wake_by(self, wake: Callable[[], object]) -> None:
        """Call this, from any thread, when there is something new."""
        self._wake = wake

    def newest(self) -> tuple[HomeState, tuple[Shape, ...]] | None:
        """The state that is to be shown, None before the first."""
        with self._lock:
            return None if self._state is None else (self._state, self._old)

    def take_events(self) -> list[HomeEvent]:
        """Return the events that wait, the oldest first, but those that are no news any more."""
        oldest_s = time.monotonic() - self._events_last_s
        with self._lock:
            events = [event for said_s, event in self._events if said_s >= oldest_s]
            self._events.clear()
        return events

    def announce(self, shape: Shape) -> None:
        """Say that nothing but this shape is retained now."""
        with self._lock:
            self._announced = shape


ForgetDay = Callable[[date], object]
"""Forgets a local day; raises StoreError or SettingsError. It may take long."""
