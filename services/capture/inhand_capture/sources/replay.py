"""The source ``replay``: a recording instead of a camera."""

import contextlib
import logging
import time
from collections.abc import Callable, Generator, Iterator, Mapping
from dataclasses import replace
from datetime import UTC, datetime
from typing import Any

import msgspec
from inhand_runtime.settings_errors import explain
from inhand_runtime.source import Captured, SourceError
from inhand_schemas.messages import CameraInfo
from inhand_schemas.playback import PlaybackReply, PlaybackRequest
from pydantic import ValidationError

from inhand_capture.sources.replay_files import PlayedFiles, named, open_files
from inhand_capture.sources.replay_options import Instant, ReplayOptions
from inhand_capture.sources.replay_playback import LONGEST_DELAY_S, Playback

log = logging.getLogger(__name__)

LONGEST_STEP_S = 5.0
"""Longest pause between two moments, in recorded seconds: a longer one is a clock that was set, or
a time in which nothing was recorded."""


class ReplaySource:
    """Plays a recording with its original timing, and its capture times or those of now."""

    options_model = ReplayOptions

    @classmethod
    def check_options(cls, options: Mapping[str, Any]) -> None:
        """Raise SourceError for a recording that is not there, or cannot be played."""
        cls(options)

    def __init__(self, options: Mapping[str, Any]) -> None:
        try:
            self._options = ReplayOptions(**options)
        except ValidationError as error:
            raise SourceError(explain(error, None, ("options",), ReplayOptions)) from None
        self._files = open_files(self._options)
        self._start_ns, self._until_ns = _bounds(self._files, self._options)
        self._playback = Playback(
            self._files.start_ns,
            (self._files.end_ns - self._files.start_ns) / 1e9,
            rate=self._options.rate,
            paused=self._options.paused,
        )
        self._now_times = _NowTimes()

    @property
    def info(self) -> CameraInfo:
        """How the recorded camera saw; with the times of now it says whence it comes."""
        info = self._files.info
        if self._options.times == "original":
            return info
        captured = datetime.fromtimestamp(self._files.start_ns / 1e9, UTC)
        whence = f"replay of {self._files.files[0].name}, captured {captured:%Y-%m-%dT%H:%M:%SZ}"
        description = f"{info.description}; {whence}" if info.description else whence
        return msgspec.structs.replace(info, time_ns=0, description=description)

    def captures(self, wanted: Callable[[], bool]) -> Iterator[Captured | None]:
        """The recorded moments, each when it is due; raises SourceError for a damaged file.

        After a pause of the process, or where it cannot keep up, playback goes on from now: what
        was due meanwhile is not sent in a burst.
        """
        from_ns = self._start_ns
        while True:
            played = yield from self._play(from_ns)
            while not self._options.loop and self._playback.holds_end():
                yield None
            target_ns = self._playback.take_target_ns()
            if self._playback.closed:
                return
            if target_ns is not None:
                self._playback.begin_anew()
                from_ns = target_ns
            elif self._options.loop and (played or from_ns != self._start_ns):
                self._playback.wait_s(1 / self._files.info.frame_rate)
                from_ns = self._start_ns
            else:
                return

    def playback(self, request: PlaybackRequest, camera: str) -> PlaybackReply:
        """Do what is asked of the playback, from any thread; the reply says how it is then."""
        problem = self._playback.obey(request)
        state = self._playback.state
        return PlaybackReply(
            camera=camera,
            paused=state.paused,
            rate=state.rate,
            position_s=state.position_s,
            length_s=self._playback.length_s,
            captured_ns=state.captured_ns,
            problem=problem,
        )

    def close(self) -> None:
        """End ``captures``."""
        self._playback.close()

    def _play(self, from_ns: int | None) -> Generator[Captured | None, None, bool]:
        """Play from a time on until the end, or until something else is to be played; returns
        whether anything was."""
        before_ns: int | None = None
        with contextlib.closing(self._files.moments(from_ns)) as recorded:
            for captured in recorded:
                if self._until_ns is not None and captured.time_ns >= self._until_ns:
                    break
                step_s = 0.0 if before_ns is None else self._step_s(before_ns, captured)
                while (due := self._playback.due_at(step_s, captured.time_ns)) is None:
                    yield None
                if due is False:
                    break
                before_ns = captured.time_ns
                yield self._timed(captured, due)
        return before_ns is not None

    def _timed(self, captured: Captured, due: float) -> Captured:
        if self._options.times == "original":
            return captured
        return replace(captured, time_ns=self._now_times.at(due))

    def _step_s(self, before_ns: int, captured: Captured) -> float:
        """Seconds from one moment to the next, bounded where the recorded clock was set."""
        step_s = (captured.time_ns - before_ns) / 1e9
        if step_s < -LONGEST_DELAY_S or step_s > LONGEST_STEP_S:
            log.warning(
                "%s: the recorded time jumps by %+.1f s, where the clock was set or nothing was "
                "recorded; playback goes on",
                named(self._files.files),
                step_s,
            )
        return min(max(step_s, 0.0), LONGEST_STEP_S)


class _NowTimes:
    """Gives moments the times at which they are due: as far apart as they were captured, at rate 1.

    Where they drift from the wall clock, as when it is set, they begin anew from it.
    """

    def __init__(self) -> None:
        self._wall_ns = 0
        self._last_ns = 0

    def at(self, due: float) -> int:
        """Return the time for what was due at a time of the monotonic clock, in seconds."""
        due_ns, now_ns = round(due * 1e9), time.time_ns()
        if abs(self._wall_ns + due_ns - now_ns) > LONGEST_DELAY_S * 1e9:
            self._wall_ns = now_ns - time.monotonic_ns()
        self._last_ns = max(self._wall_ns + due_ns, self._last_ns + 1)
        return self._last_ns


def _bounds(files: PlayedFiles, options: ReplayOptions) -> tuple[int | None, int | None]:
    """Return the times of capture between which is played; None where nothing bounds it.

    Raises SourceError where nothing lies between them.
    """
    start_ns = _time_ns(files, options.start)
    until_ns = None if options.until is None else _time_ns(files, options.until)
    if start_ns > files.end_ns:
        raise SourceError(
            f"start is after the end of {named(files.files)}, which lasts "
            f"{(files.end_ns - files.start_ns) / 1e9:.3f} s until {_written(files.end_ns)}"
        )
    if until_ns is not None and until_ns <= max(start_ns, files.start_ns):
        begin = _written(max(start_ns, files.start_ns))
        raise SourceError(f"until is not after {begin}, where playback starts")
    return (start_ns if start_ns > files.start_ns else None), until_ns


def _time_ns(files: PlayedFiles, instant: Instant) -> int:
    if isinstance(instant, datetime):
        since = instant - _EPOCH
        return (since.days * 86_400 + since.seconds) * 10**9 + since.microseconds * 1_000
    return files.start_ns + round(instant * 1e9)


_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)


def _written(time_ns: int) -> str:
    return datetime.fromtimestamp(time_ns / 1e9, UTC).isoformat(timespec="milliseconds")
