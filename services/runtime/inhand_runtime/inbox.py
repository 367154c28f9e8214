"""Bounded hand-over from Zenoh's threads to a daemon's own."""

import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field

UNBOUNDED = 1 << 62


@dataclass(frozen=True)
class Received:
    """A sample as it came, not yet decoded.

    It came at ``received_ns`` by the calendar, and at ``arrived``, in seconds, by the clock that
    nobody sets.
    """

    key: str
    payload: bytes
    encoding: str
    received_ns: int
    arrived: float = field(default_factory=time.monotonic, compare=False)


class Inbox:
    """Lanes of samples, read in the order of arrival; the oldest of a full lane is dropped."""

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._lanes: list[Lane] = []
        self._arrivals = 0
        self._closed = False

    def lane(
        self, *, samples: int, size: int = UNBOUNDED, on_drop: Callable[[str], None]
    ) -> "Lane":
        """A new lane for ``samples`` and ``size`` bytes; ``on_drop`` gets the keys of drops."""
        lane = Lane(self, samples, size, on_drop)
        with self._changed:
            self._lanes.append(lane)
        return lane

    def remove(self, lane: "Lane") -> None:
        """Forget a lane with all that waits in it."""
        with self._changed:
            self._lanes.remove(lane)

    def get(self, timeout: float) -> Received | None:
        """The next sample; None after the timeout (seconds), or when closed and empty."""
        with self._changed:
            self._changed.wait_for(lambda: self._closed or self._oldest() is not None, timeout)
            lane = self._oldest()
            return None if lane is None else lane.pop()

    def close(self) -> None:
        """Take no more samples and wake the reader; what is queued can still be read."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()

    def put(self, lane: "Lane", sample: Received) -> list[Received]:
        """Queue a sample in a lane of this inbox; returns what had to be dropped for it."""
        with self._changed:
            if self._closed:
                return []
            self._arrivals += 1
            lane.push(self._arrivals, sample)
            self._changed.notify_all()
            return lane.shrink()

    def _oldest(self) -> "Lane | None":
        waiting = [lane for lane in self._lanes if lane.queue]
        return min(waiting, key=lambda lane: lane.queue[0][0], default=None)


class Lane:
    """One stream's share of an inbox; ``put`` is for everybody, the rest for the inbox's lock."""

    def __init__(
        self, inbox: Inbox, samples: int, size: int, on_drop: Callable[[str], None]
    ) -> None:
        self.queue: deque[tuple[int, Received]] = deque()
        self._inbox = inbox
        self._samples = samples
        self._size = size
        self._on_drop = on_drop
        self._bytes = 0

    def put(self, sample: Received) -> None:
        """Queue a sample, from any thread; never waits for the reader."""
        for dropped in self._inbox.put(self, sample):
            self._on_drop(dropped.key)

    def push(self, arrival: int, sample: Received) -> None:
        """Append a sample with its number in the inbox."""
        self.queue.append((arrival, sample))
        self._bytes += len(sample.payload)

    def pop(self) -> Received:
        """Take the oldest."""
        _, sample = self.queue.popleft()
        self._bytes -= len(sample.payload)
        return sample

    def shrink(self) -> list[Received]:
        """Take the oldest until the bounds hold, but never the only one."""
        dropped = []
        while len(self.queue) > 1 and (len(self.queue) > self._samples or self._bytes > self._size):
            dropped.append(self.pop())
        return dropped
