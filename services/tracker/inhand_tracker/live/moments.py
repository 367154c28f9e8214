"""Brings skeletons together with the pixels of the same frame, and says which moment is next.

Skeletons are small and arrive first; their frames follow within a period of the camera, unless the
network cannot carry them. So a skeleton waits for its frame one period at the most, and not for one
that cannot come: when a later frame is there, or when no pixels flow at all. What waits no more is
ready, and the newest that is ready is next. Older ones are skipped: whoever is slower than the
camera would come later and later.

Where every moment matters more than being on time, none is skipped: they come in their order, and
each waits for its frame as long as pixels flow.
"""

from collections import deque
from dataclasses import dataclass
from typing import Generic, TypeVar

from inhand_tracker.live.arrivals import Arrivals
from inhand_tracker.live.parameters import DEFAULT_MOMENTS, MomentsParameters

SkeletonT = TypeVar("SkeletonT")
FrameT = TypeVar("FrameT")


@dataclass(frozen=True)
class Moment(Generic[SkeletonT, FrameT]):
    """What is worked on next: a skeleton, its frame if there is one, and the skeletons before it,
    oldest first, that are skipped."""

    skeleton: SkeletonT
    frame: FrameT | None = None
    skipped: tuple[SkeletonT, ...] = ()


@dataclass(frozen=True)
class _Waiting(Generic[SkeletonT]):
    """A skeleton, when it arrived, and the number of the camera's start that it is of."""

    sequence: int
    skeleton: SkeletonT
    arrived: float
    start: int


class Moments(Generic[SkeletonT, FrameT]):
    """Pairs skeletons and frames by their sequence; times are seconds of one monotonic clock.

    ``pixels`` says whether frames are wanted at all, ``every`` whether no skeleton is skipped.
    """

    def __init__(
        self,
        *,
        pixels: bool = True,
        every: bool = False,
        parameters: MomentsParameters = DEFAULT_MOMENTS,
    ) -> None:
        self._pixels = pixels
        self._every = every
        self._parameters = parameters
        self._arrivals = Arrivals(parameters)
        self._waiting: deque[_Waiting[SkeletonT]] = deque()
        self._frames: dict[int, FrameT] = {}
        self._start = 0
        self._newest_skeleton = self._newest_frame = -1
        self._skeleton_at = float("-inf")
        self._flowing_until = float("-inf")
        self._unused_frames = 0

    @property
    def period_s(self) -> float:
        """Seconds from one skeleton of the camera to the next."""
        return self._arrivals.period_s

    def add_skeleton(self, sequence: int, skeleton: SkeletonT, arrived: float) -> None:
        """Take a skeleton; a sequence that went back means that the camera was restarted."""
        if sequence < self._newest_skeleton:
            self._restart()
        if arrived - self._skeleton_at > self._parameters.flowing_s:
            self._flowing_until = arrived + self._parameters.flowing_s
        self._newest_skeleton, self._skeleton_at = sequence, arrived
        self._arrivals.add(arrived)
        self._waiting.append(_Waiting(sequence, skeleton, arrived, self._start))

    def add_frame(self, sequence: int, frame: FrameT, arrived: float) -> None:
        """Take a frame; beside those that are waited for only the newest few are kept."""
        if sequence < self._newest_frame:
            self._restart()
        self._newest_frame = sequence
        self._flowing_until = arrived + self._parameters.flowing_s
        self._frames[sequence] = frame
        while len(self._frames) > self._parameters.frames_kept + len(self._waiting):
            self._leave_frame(next(iter(self._frames)))

    def wait_s(self, now: float) -> float:
        """Seconds until ``next`` gives a moment, if nothing arrives; infinite if it never does."""
        return max(min(map(self._ready_at, self._waiting), default=float("inf")) - now, 0.0)

    def decided(self) -> bool:
        """Whether the oldest skeleton has nothing to wait for, whatever comes."""
        return bool(self._waiting) and self._ready_at(self._waiting[0]) <= self._waiting[0].arrived

    def next(self, now: float) -> Moment[SkeletonT, FrameT] | None:
        """Give the next moment; None while there is none, or all have to wait."""
        ready = [number for number, one in enumerate(self._waiting) if self._ready_at(one) <= now]
        if not ready:
            return None
        before = [self._waiting.popleft() for _ in range(ready[0 if self._every else -1])]
        chosen = self._waiting.popleft()
        skipped = tuple(one.skeleton for one in before)
        return Moment(chosen.skeleton, self._take_frame(chosen), skipped)

    def take_unused_frames(self) -> int:
        """Number of frames since the last call that came and were not given out."""
        count, self._unused_frames = self._unused_frames, 0
        return count

    def leave(self) -> int:
        """Give up all that waits, at the end; returns the number of skeletons."""
        left = len(self._waiting)
        self._waiting.clear()
        for sequence in list(self._frames):
            self._leave_frame(sequence)
        return left

    def _ready_at(self, one: _Waiting[SkeletonT]) -> float:
        """The time from which on a skeleton waits no more."""
        frame_may_come = one.start == self._start and one.sequence > self._newest_frame
        if not self._pixels or not frame_may_come:
            return one.arrived
        if self._every:
            return self._flowing_until
        patience_s = self._parameters.patience * self.period_s
        return min(one.arrived + patience_s, self._flowing_until)

    def _take_frame(self, one: _Waiting[SkeletonT]) -> FrameT | None:
        """A skeleton's frame, if it is there; those before it are of no more use."""
        if one.start != self._start:
            return None
        for sequence in [earlier for earlier in self._frames if earlier < one.sequence]:
            self._leave_frame(sequence)
        return self._frames.pop(one.sequence, None)

    def _leave_frame(self, sequence: int) -> None:
        del self._frames[sequence]
        self._unused_frames += 1

    def _restart(self) -> None:
        """Forget frames of before the camera's restart: their numbers come again."""
        for sequence in list(self._frames):
            self._leave_frame(sequence)
        self._start += 1
        self._newest_skeleton = self._newest_frame = -1
