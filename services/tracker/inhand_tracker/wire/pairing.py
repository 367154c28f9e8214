"""Brings skeletons together with the pixels of the same frame.

Skeletons are small and arrive first. Each waits for its frame, but not for one that will not
come: when a later frame is there, when it has waited long enough, or when no pixels flow at all.
"""

from collections import deque
from dataclasses import dataclass
from typing import Generic, TypeVar

from inhand_tracker.wire.parameters import DEFAULT_PAIRING, PairingParameters

SkeletonT = TypeVar("SkeletonT")
FrameT = TypeVar("FrameT")


@dataclass(frozen=True)
class _Waiting(Generic[SkeletonT]):
    sequence: int
    skeleton: SkeletonT
    since: float


class Pairing(Generic[SkeletonT, FrameT]):
    """Pairs skeletons and frames by their sequence; times are seconds of one monotonic clock."""

    def __init__(self, parameters: PairingParameters = DEFAULT_PAIRING) -> None:
        self._parameters = parameters
        self._waiting: deque[_Waiting[SkeletonT]] = deque()
        self._frames: dict[int, FrameT] = {}
        self._last_frame_at = float("-inf")
        self._last_skeleton = -1

    def add_skeleton(self, sequence: int, skeleton: SkeletonT, now: float) -> None:
        """Take a skeleton; a sequence that went back means that the camera was restarted."""
        if sequence < self._last_skeleton:
            self._frames.clear()
        self._last_skeleton = sequence
        self._waiting.append(_Waiting(sequence, skeleton, now))

    def add_frame(self, sequence: int, frame: FrameT, now: float) -> None:
        """Take a frame; only the newest few are kept."""
        if self._frames and sequence < next(reversed(self._frames)):
            self._frames.clear()
            self._last_skeleton = -1
        self._frames[sequence] = frame
        while len(self._frames) > self._parameters.frames_kept:
            del self._frames[next(iter(self._frames))]
        self._last_frame_at = now

    def pop(self, now: float) -> tuple[SkeletonT, FrameT | None] | None:
        """Give the oldest skeleton, with its frame or without; None while it has to wait."""
        if not self._waiting or self._must_wait(self._waiting[0], now):
            return None
        oldest = self._waiting.popleft()
        return oldest.skeleton, self._frames.get(oldest.sequence)

    def _must_wait(self, oldest: _Waiting[SkeletonT], now: float) -> bool:
        """Whether the frame of a skeleton may still come."""
        flowing = now - self._last_frame_at < self._parameters.flowing_s
        newest_frame = next(reversed(self._frames), -1)
        patient = now - oldest.since < self._parameters.longest_wait_s
        return flowing and newest_frame < oldest.sequence and patient
