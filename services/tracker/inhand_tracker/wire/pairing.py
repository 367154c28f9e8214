"""Brings skeletons together with the pixels of the same frame.

Skeletons are small and arrive first. Each waits for its frame, but not for one that will not
come: when a later frame is there, when it has waited long enough, or when no pixels flow at all.
Where frames come faster than they are used, the newest skeleton whose frame is there is next, and
what is older is dropped: in order, no skeleton would ever meet its frame again.
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
    """Pairs skeletons and frames by their sequence; times are seconds of one monotonic clock.

    ``dropped_skeletons`` and ``unused_frames`` count what came and was not given out.
    """

    def __init__(self, parameters: PairingParameters = DEFAULT_PAIRING) -> None:
        self._parameters = parameters
        self.dropped_skeletons = 0
        self.unused_frames = 0
        self._used: set[int] = set()
        self._waiting: deque[_Waiting[SkeletonT]] = deque()
        self._frames: dict[int, FrameT] = {}
        self._last_frame_at = float("-inf")
        self._last_skeleton = -1

    def add_skeleton(self, sequence: int, skeleton: SkeletonT, now: float) -> None:
        """Take a skeleton; a sequence that went back means that the camera was restarted."""
        if sequence < self._last_skeleton:
            self._forget_frames()
        self._last_skeleton = sequence
        self._waiting.append(_Waiting(sequence, skeleton, now))

    def add_frame(self, sequence: int, frame: FrameT, now: float) -> None:
        """Take a frame; only the newest few are kept."""
        if self._frames and sequence < next(reversed(self._frames)):
            self._forget_frames()
            self._last_skeleton = -1
        self._frames[sequence] = frame
        while len(self._frames) > self._parameters.frames_kept:
            self._forget_frame(next(iter(self._frames)))
        self._last_frame_at = now

    def ready(self, now: float) -> bool:
        """Whether ``pop`` would give a skeleton."""
        return bool(self._waiting) and not self._must_wait(self._waiting[0], now)

    def pop(self, now: float) -> tuple[SkeletonT, FrameT | None] | None:
        """Give the next skeleton, with its frame or without; None while it has to wait."""
        self._drop_what_is_too_old(now)
        if not self.ready(now):
            return None
        oldest = self._waiting.popleft()
        self._used.add(oldest.sequence)
        return oldest.skeleton, self._frames.get(oldest.sequence)

    def _drop_what_is_too_old(self, now: float) -> None:
        """While behind, keep the newest skeleton whose frame is there, and what comes after it."""
        if len(self._waiting) <= self._parameters.most_waiting or not self._flowing(now):
            return
        paired = [n for n, one in enumerate(self._waiting) if one.sequence in self._frames]
        for _ in range(paired[-1] if paired else 0):
            self._waiting.popleft()
            self.dropped_skeletons += 1

    def _forget_frame(self, sequence: int) -> None:
        del self._frames[sequence]
        self.unused_frames += sequence not in self._used
        self._used.discard(sequence)

    def _forget_frames(self) -> None:
        for sequence in list(self._frames):
            self._forget_frame(sequence)
        self._used.clear()

    def _flowing(self, now: float) -> bool:
        return now - self._last_frame_at < self._parameters.flowing_s

    def _must_wait(self, oldest: _Waiting[SkeletonT], now: float) -> bool:
        """Whether the frame of a skeleton may still come."""
        newest_frame = next(reversed(self._frames), -1)
        patient = now - oldest.since < self._parameters.longest_wait_s
        return self._flowing(now) and newest_frame < oldest.sequence and patient
