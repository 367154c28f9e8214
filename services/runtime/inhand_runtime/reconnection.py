"""Connects peers again that lost the link between them.

Zenoh retries only the addresses of its settings. Two peers that met by gossip, and whose link was
closed since one of them or the network stood still, stay apart for ever; but whoever joins is told
of everybody, and tells each of all others. So who loses a peer opens a second session for a moment,
a go-between, by which all meet again. Where the lost one has ended that is in vain, and cheap.
"""

import contextlib
import random
import threading
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from dataclasses import dataclass


@dataclass(frozen=True)
class ReconnectionParameters:
    """When a go-between is sent, and how often."""

    earliest_s: float = 0.1
    """Seconds after a loss before which no go-between is sent: the other end has to lose it too."""
    latest_s: float = 0.6
    """Seconds after which one is; each draws its own time, and the first acts for all."""
    stays_s: float = 0.5
    """Seconds that a go-between stays: on a busy machine links take that long."""
    attempts: int = 3
    """Number of go-betweens for one loss: where the lost one is met, and still not connected, or
    nobody is met at all, one more may help."""


RECONNECTION = ReconnectionParameters()


@dataclass(frozen=True)
class Links:
    """Who is connected with a session, go-betweens apart."""

    peers: frozenset[str] = frozenset()
    go_betweens: frozenset[str] = frozenset()


GoBetween = Callable[[], AbstractContextManager[Callable[[], Links]]]
"""Opens a session that meets all others, and says with whom it is connected."""


class Reconnection:
    """Sends a go-between whenever a peer of a session is lost."""

    def __init__(self, links: Callable[[], Links], go_between: GoBetween) -> None:
        self._links = links
        self._go_between = go_between
        self._lock = threading.Lock()
        self._lost: frozenset[str] = frozenset()
        self._wakes = threading.Event()
        self._ends = threading.Event()

    def lose(self, peer: str) -> None:
        """Take note of a peer whose link was closed."""
        with self._lock:
            self._lost |= {peer}
        self._wakes.set()

    @contextlib.contextmanager
    def running(self) -> Iterator[None]:
        """Look after lost peers until the block ends."""
        thread = threading.Thread(target=self._run, name="reconnection", daemon=True)
        thread.start()
        try:
            yield
        finally:
            self._ends.set()
            self._wakes.set()
            thread.join()

    def _run(self) -> None:
        while self._wakes.wait() and not self._ends.is_set():
            self._wakes.clear()
            with self._lock:
                lost, self._lost = self._lost, frozenset()
            for _ in range(RECONNECTION.attempts):
                if self._another_goes() or self._introduces(lost - self._links().peers):
                    break

    def _another_goes(self) -> bool:
        """Wait for a time of one's own; whether somebody else's go-between has come meanwhile."""
        before = self._links().go_betweens
        self._ends.wait(random.uniform(RECONNECTION.earliest_s, RECONNECTION.latest_s))
        return self._ends.is_set() or bool(self._links().go_betweens - before)

    def _introduces(self, lost: frozenset[str]) -> bool:
        """Send a go-between; whether it meets others, and no lost one that is not back."""
        if not lost:
            return True
        with self._go_between() as its_links:
            self._ends.wait(RECONNECTION.stays_s)
            met = its_links().peers
        return bool(met) and not (lost & met - self._links().peers)
