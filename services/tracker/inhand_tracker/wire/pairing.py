"""Brings skeletons together with the pixels of the same frame.

Skeletons are small and arrive first. Each waits for its frame, but not for one that will not
come: when a later frame is there, when it has waited long enough, or when no pixels flow at all.
"""

from collections import deque
from dataclasses import dataclass
from typing import Generic, TypeVar

T = TypeVar("T")

FLOWING_S = 1.0
LONGEST_WAIT_S = 0.05
FRAMES_KEPT = 4


@dataclass(frozen=True)
class _Waiting(Generic[T]):
    sequence: int
    skeleton: T
    since: float


F = TypeVar("F")


class Pairing(Generic[T, F]):
    """Times are seconds of one monotonic clock."""

    def __init__(self) -> None:
        self._waiting: deque[_Waiting[T]] = deque()
        self._frames: dict[int, F] = {}
        self._last_frame_at = float("-inf")
        self._last_skeleton = -1

    def add_skeleton(self, sequence: int, skeleton: T, now: float) -> None:
        """Take a skeleton; a sequence that went back tells of a restarted camera."""
        if sequence < self._last_skeleton:
            self._frames.clear()
        self._last_skeleton = sequence
        self._waiting.append(_Waiting(sequence, skeleton, now))

    def add_frame(self, sequence: int, frame: F, now: float) -> None:
        """Take a frame; only the newest few are kept."""
        if self._frames and sequence < next(reversed(self._frames)):
            self._frames.clear()
            self._last_skeleton = -1
        self._frames[sequence] = frame
        while len(self._frames) > FRAMES_KEPT:
            del self._frames[next(iter(self._frames))]
        self._last_frame_at = now

    def pop(self, now: float) -> tuple[T, F | None] | None:
        """The oldest skeleton that need not wait, with its frame or without; or None."""
        if not self._waiting:
            return None
        oldest = self._waiting[0]
        flowing = now - self._last_frame_at < FLOWING_S
        newest_frame = next(reversed(self._frames), -1)
        if flowing and newest_frame < oldest.sequence and now - oldest.since < LONGEST_WAIT_S:
            return None
        self._waiting.popleft()
        return oldest.skeleton, self._frames.get(oldest.sequence)
