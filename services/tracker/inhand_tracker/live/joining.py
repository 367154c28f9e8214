"""Joins what several cameras capture at about the same time, and says which moment is next.

Each camera's skeletons and frames come by themselves, at times of its own. A moment is that of the
first camera, in the order of the rig, that has captured something new; the others add what they
captured nearest to it, once at the most. It waits for what is due, but no longer than a share of
the period: a camera that fails, or is always too late, is not waited for. The newest moment is
next; older ones are skipped, unless every one matters.
"""

import math
from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from statistics import median
from typing import Generic, TypeVar

from inhand_tracker.live.arrivals import Arrivals
from inhand_tracker.live.parameters import (
    DEFAULT_JOINING,
    DEFAULT_MOMENTS,
    JoiningParameters,
    MomentsParameters,
)

SkeletonT = TypeVar("SkeletonT")
FrameT = TypeVar("FrameT")


@dataclass
class Captured(Generic[SkeletonT, FrameT]):
    """What a camera captured at ``time_ns`` by the rig's clock: its skeletons, and the frame, None
    while, or if, it does not come."""

    camera: str
    sequence: int
    time_ns: int
    skeleton: SkeletonT
    arrived: float
    frame: FrameT | None = None


@dataclass(frozen=True)
class JoinedMoment(Generic[SkeletonT, FrameT]):
    """What is worked on next: what cameras captured, whose moment it is first; and such moments
    before it, oldest first, that are skipped."""

    captured: Sequence[Captured[SkeletonT, FrameT]]
    skipped: Sequence[Sequence[Captured[SkeletonT, FrameT]]] = ()


class _Camera(Generic[SkeletonT, FrameT]):
    """One camera's captures that nobody has used, oldest first, and how it keeps time."""

    def __init__(self, name: str, parameters: MomentsParameters) -> None:
        self.name = name
        self.captures: deque[Captured[SkeletonT, FrameT]] = deque()
        self.frames: dict[int, FrameT] = {}
        self.arrivals = Arrivals(parameters)
        self.newest_sequence = self.newest_frame = -1
        self.newest_ns = -1
        self.arrived = -math.inf
        self.flowing_until = -math.inf
        self.missed = 0
        self.delays: deque[float] = deque(maxlen=parameters.intervals)

    @property
    def delay_s(self) -> float:
        """Seconds by which captures arrive after their times, by clocks of different zeros."""
        return median(self.delays)


class JoinedMoments(Generic[SkeletonT, FrameT]):
    """Joins the captures of ``cameras``, in the order of the rig, and pairs skeletons and frames by
    their sequence; times of arrival are seconds of one monotonic clock.

    ``pixels`` says whether frames are wanted at all, ``every`` whether no moment is skipped.
    """

    def __init__(
        self,
        cameras: Sequence[str],
        *,
        pixels: bool = True,
        every: bool = False,
        parameters: MomentsParameters = DEFAULT_MOMENTS,
        joining: JoiningParameters = DEFAULT_JOINING,
    ) -> None:
        self._cameras: dict[str, _Camera[SkeletonT, FrameT]] = {
            name: _Camera(name, parameters) for name in cameras
        }
        self._pixels = pixels
        self._every = every
        self._parameters = parameters
        self._joining = joining
        self._last_ns = -1
        self._unused: dict[str, list[int]] = {name: [0, 0] for name in cameras}

    @property
    def period_s(self) -> float:
        """Seconds from one moment to the next: the period of the first camera that sends."""
        alive = (one for one in self._cameras.values() if one.delays)
        first = next(alive, next(iter(self._cameras.values())))
        return first.arrivals.period_s

    def add_skeleton(
        self, camera: str, sequence: int, time_ns: int, skeleton: SkeletonT, arrived: float
    ) -> None:
        """Take a skeleton, captured at a time by the rig's clock; a sequence that went back means
        that the camera was restarted."""
        one = self._cameras[camera]
        if sequence < one.newest_sequence:
            self._restart(one)
        one.newest_sequence, one.newest_ns = sequence, time_ns
        one.arrivals.add(arrived)
        if arrived - one.arrived > self._parameters.flowing_s:
            one.flowing_until = arrived + self._parameters.flowing_s
        one.arrived = arrived
        one.delays.append(arrived - time_ns / 1e9)
        frame = one.frames.pop(sequence, None)
        one.captures.append(Captured(camera, sequence, time_ns, skeleton, arrived, frame))

    def add_frame(self, camera: str, sequence: int, frame: FrameT, arrived: float) -> None:
        """Take a frame; of those without a skeleton only the newest few are kept."""
        one = self._cameras[camera]
        if sequence < one.newest_frame:
            self._restart(one)
        one.newest_frame = sequence
        one.flowing_until = arrived + self._parameters.flowing_s
        for captured in one.captures:
            if captured.sequence == sequence:
                captured.frame = frame
                return
        one.frames[sequence] = frame
        while len(one.frames) > self._parameters.frames_kept:
            del one.frames[next(iter(one.frames))]
            self._unused[camera][1] += 1

    def odd_clocks(self) -> Mapping[str, float]:
        """Cameras whose times cannot be those of the others, and by how many seconds they are
        ahead, by when what they captured arrives."""
        newest = max(one.arrived for one in self._cameras.values())
        delays = {
            name: one.delay_s
            for name, one in self._cameras.items()
            if one.delays and newest - one.arrived < self._parameters.flowing_s
        }
        if len(delays) < 2:
            return {}
        # Of two the first one is believed.
        usual = median(delays.values()) if len(delays) > 2 else next(iter(delays.values()))
        return {
            name: usual - delay
            for name, delay in delays.items()
            if abs(usual - delay) > self._joining.odd_clock_s
        }

    def wait_s(self, now: float) -> float:
        """Seconds until ``next`` gives a moment, if nothing arrives; infinite if it never does."""
        found = self._source(now)
        return math.inf if found is None else max(found[1] - now, 0.0)

    def decided(self) -> bool:
        """Whether the next moment has nothing to wait for, whatever comes."""
        found = self._source(-math.inf)
        return found is not None and found[1] == -math.inf

    def next(self, now: float) -> JoinedMoment[SkeletonT, FrameT] | None:
        """Give the next moment; None while there is none, or all have to wait."""
        found = self._source(now)
        if found is None or found[1] > now:
            return None
        source = found[0]
        camera = self._cameras[source.camera]
        skipped = []
        while camera.captures[0] is not source:
            earlier = camera.captures[0]
            if self._is_new(earlier):
                skipped.append(self._join(earlier))
            else:
                self._drop(camera)
        moment = JoinedMoment(self._join(source), skipped)
        self._forget_old(source.time_ns)
        return moment

    def take_unused(self) -> Iterator[tuple[str, int, int]]:
        """Give each camera's numbers of skeletons and frames, since the last call, that came and
        were not given out."""
        for name, counts in self._unused.items():
            yield name, counts[0], counts[1]
            counts[:] = 0, 0

    def leave(self) -> None:
        """Give up all that waits, at the end."""
        for one in self._cameras.values():
            self._restart(one)
            while one.captures:
                self._drop(one)

    def _is_new(self, captured: Captured[SkeletonT, FrameT]) -> bool:
        """Whether a capture is of a moment that was not worked on; a clock that went far back is
        that of another time."""
        ahead_s = (captured.time_ns - self._last_ns) / 1e9
        return ahead_s > self.period_s / 2.0 or ahead_s < -self._joining.restart_s

    def _source(self, now: float) -> tuple[Captured[SkeletonT, FrameT], float] | None:
        """The capture whose moment is next, and when it waits no more."""
        odd = self.odd_clocks()
        names = [name for name in self._cameras if name not in odd] or list(self._cameras)
        fresh = {}
        for name in names:
            new = [one for one in self._cameras[name].captures if self._is_new(one)]
            if new:
                fresh[name] = new
        if not fresh:
            return None
        first_arrived = min(new[0].arrived for new in fresh.values())
        name = next(iter(fresh))
        source = fresh[name][0 if self._every else -1]
        before = names[: names.index(name)]
        ready = max(
            (self._ready_at(self._cameras[other], source, now) for other in names),
            default=-math.inf,
        )
        if any(self._is_alive(self._cameras[other], source.arrived) for other in before):
            takeover = first_arrived + self._joining.takeover * self.period_s
            ready = max(ready, takeover)
        return source, ready

    def _ready_at(
        self, one: _Camera[SkeletonT, FrameT], source: Captured[SkeletonT, FrameT], now: float
    ) -> float:
        """Until when a moment waits for what a camera captured about then."""
        if one.name != source.camera and not self._is_waited_for(one, source):
            return -math.inf
        nearest = self._nearest(one, source)
        due = nearest is None or (source.time_ns - nearest.time_ns) / 1e9 > self.period_s / 2.0
        if due:
            # What came before it is older than it can be.
            if one.name == source.camera or one.newest_ns >= source.time_ns:
                return -math.inf
            return source.arrived + self._patience_s(one)
        assert nearest is not None
        if not self._pixels or nearest.frame is not None or nearest.sequence <= one.newest_frame:
            return -math.inf
        if self._every:
            return one.flowing_until
        return min(nearest.arrived + self._patience_s(one), one.flowing_until)

    def _patience_s(self, one: _Camera[SkeletonT, FrameT]) -> float:
        if self._every:
            return self._parameters.flowing_s
        return self._joining.patience * self.period_s

    def _is_alive(self, one: _Camera[SkeletonT, FrameT], now: float) -> bool:
        """Whether a camera sends: something came within a few periods."""
        return now - one.arrived < self._joining.alive_periods * one.arrivals.period_s

    def _is_waited_for(
        self, one: _Camera[SkeletonT, FrameT], source: Captured[SkeletonT, FrameT]
    ) -> bool:
        if self._every:
            return source.arrived - one.arrived < self._parameters.flowing_s
        if one.missed >= self._joining.most_missed:
            return False
        next_ns = one.newest_ns + 1e9 * one.arrivals.period_s
        due = next_ns <= source.time_ns + 0.5e9 * self.period_s or one.newest_ns >= source.time_ns
        return due and self._is_alive(one, source.arrived)

    def _nearest(
        self, one: _Camera[SkeletonT, FrameT], source: Captured[SkeletonT, FrameT]
    ) -> Captured[SkeletonT, FrameT] | None:
        """What a camera captured nearest to a moment, and not too far from it."""
        if one.name == source.camera:
            return source
        reach_ns = 1e9 * self._joining.reach * self.period_s
        return min(
            (each for each in one.captures if abs(each.time_ns - source.time_ns) <= reach_ns),
            key=lambda each: abs(each.time_ns - source.time_ns),
            default=None,
        )

    def _join(self, source: Captured[SkeletonT, FrameT]) -> Sequence[Captured[SkeletonT, FrameT]]:
        """Take out what was captured at a moment, and what is older."""
        joined = [source]
        odd = self.odd_clocks()
        for name, one in self._cameras.items():
            nearest = None
            if name == source.camera or name not in odd:
                nearest = self._nearest(one, source)
            if nearest is None:
                one.missed += 1
                continue
            in_time = abs(nearest.time_ns - source.time_ns) / 1e9 <= self.period_s / 2.0
            one.missed = 0 if in_time else one.missed + 1
            while one.captures[0] is not nearest:
                self._drop(one)
            one.captures.popleft()
            if name != source.camera:
                joined.append(nearest)
        self._last_ns = source.time_ns
        return joined

    def _forget_old(self, time_ns: int) -> None:
        """Forget what is too old for any moment to come, and what an odd clock stamped."""
        for one in self._cameras.values():
            while one.captures and (
                one.captures[0].time_ns < time_ns - 1e9 * self._joining.reach * self.period_s
                or len(one.captures) > self._joining.most_captures
            ):
                self._drop(one)

    def _drop(self, one: _Camera[SkeletonT, FrameT]) -> None:
        """Leave a camera's oldest capture unused."""
        dropped = one.captures.popleft()
        self._unused[one.name][0] += 1
        self._unused[one.name][1] += dropped.frame is not None

    def _restart(self, one: _Camera[SkeletonT, FrameT]) -> None:
        """Forget frames of before a camera's restart: their numbers come again."""
        self._unused[one.name][1] += len(one.frames)
        one.frames.clear()
        one.newest_sequence = one.newest_frame = -1
        one.delays.clear()
