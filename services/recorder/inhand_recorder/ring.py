"""The last seconds of what came, in memory: bounded in seconds and in bytes."""

from collections import deque
from dataclasses import dataclass

from inhand_recorder.recording_file import Entry

ENTRY_BYTES = 900
"""Bytes of memory that an entry takes beside its payload: its key, its numbers and its places
(`tests/recorder/test_ring.py` measures it)."""


@dataclass(frozen=True)
class RingBounds:
    """How much a ring holds: what came in the last ``seconds``, and ``size`` bytes of memory; 0
    seconds is no ring."""

    seconds: float = 0.0
    size: int = 0


class Ring:
    """Entries with the times at which they came, in seconds, numbered from 0 on as they come."""

    def __init__(self, bounds: RingBounds) -> None:
        self._bounds = bounds
        self._entries: deque[tuple[float, Entry]] = deque()
        self._bytes = 0
        self.first = 0
        """The number of the oldest entry that is held."""

    @property
    def end(self) -> int:
        """The number of the next entry to come."""
        return self.first + len(self._entries)

    @property
    def bytes(self) -> int:
        """How much memory the entries take."""
        return self._bytes

    @property
    def seconds(self) -> float:
        """From the oldest entry to the newest."""
        return self._entries[-1][0] - self._entries[0][0] if self._entries else 0.0

    def __getitem__(self, number: int) -> tuple[float, Entry]:
        """Return an entry that is held, with the time at which it came."""
        return self._entries[number - self.first]

    def add(self, arrived: float, entry: Entry) -> None:
        """Hold one more entry."""
        self._entries.append((arrived, entry))
        self._bytes += _size(entry)

    def must_shrink(self, now: float, coming: int = 0) -> bool:
        """Whether the oldest entry has to go, now or before an entry with ``coming`` bytes of
        payload is added."""
        if not self._entries:
            return False
        too_old = self._entries[0][0] < now - self._bounds.seconds
        needed = coming + ENTRY_BYTES if coming else 0
        return too_old or self._bytes + needed > self._bounds.size

    def drop_oldest(self) -> Entry:
        """Hold the oldest entry no longer, and return it."""
        _, entry = self._entries.popleft()
        self._bytes -= _size(entry)
        self.first += 1
        return entry


def _size(entry: Entry) -> int:
    return len(entry.payload) + ENTRY_BYTES
