"""How a recording is played at the moment: paused or not, how fast, and where to go next.

Whoever plays waits here, and whoever controls it changes it from another thread.
"""

import threading
import time
from dataclasses import dataclass

from inhand_runtime.source import QUIET_S
from inhand_schemas.playback import PlaybackRequest

LONGEST_DELAY_S = 0.5
"""Seconds late from which on playback goes on from now instead of hurrying after its times."""


@dataclass(frozen=True)
class PlaybackState:
    """Where a replay is; ``position_s`` is recorded seconds from the begin, of what was played
    last, and ``captured_ns`` when that was captured; both are None before the first moment."""

    paused: bool
    rate: float
    position_s: float | None
    captured_ns: int | None


class Playback:
    """The state of one replay, for two threads."""

    def __init__(self, begin_ns: int, length_s: float, *, rate: float, paused: bool) -> None:
        self.length_s = length_s
        self._begin_ns = begin_ns
        self._changed = threading.Condition()
        self._rate, self._paused = rate, paused
        self._steps = 0
        self._target_s: float | None = None
        self._captured_ns: int | None = None
        self._closed = False
        self._due: float | None = None
        """When the last moment was due, by the monotonic clock."""

    @property
    def state(self) -> PlaybackState:
        """How it is played now."""
        with self._changed:
            return PlaybackState(self._paused, self._rate, self._position_s(), self._captured_ns)

    @property
    def closed(self) -> bool:
        """Whether it has come to its end on demand."""
        return self._closed

    def obey(self, request: PlaybackRequest) -> str | None:
        """Do what is asked, from any thread; return why that cannot be."""
        value = request.value
        if request.action in ("seek", "skip", "rate"):
            if value is None or not abs(value) < float("inf"):
                return f"{request.action} needs a number"
            if request.action == "rate" and value < 0.0:
                return f"a rate is 0 or more, not {value:g}"
        with self._changed:
            self._obey(request.action, 0.0 if value is None else value)
            self._changed.notify_all()
        return None

    def close(self) -> None:
        """End it, from any thread."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()

    def take_target_ns(self) -> int | None:
        """Return the time of capture at which to go on, where that was asked for."""
        with self._changed:
            target_s, self._target_s = self._target_s, None
        return None if target_s is None else self._begin_ns + round(target_s * 1e9)

    def begin_anew(self) -> None:
        """Let the next moment be due at once: what was played before is over."""
        with self._changed:
            self._due = None

    def wait_s(self, recorded_s: float) -> None:
        """Let the next moment be due later by a recorded time, in seconds."""
        with self._changed:
            if self._due is not None:
                self._due += self._step_s(recorded_s)

    def due_at(self, recorded_s: float, captured_ns: int) -> float | bool | None:
        """Wait until the moment may be played that was captured at ``captured_ns``, and
        ``recorded_s`` seconds after the last one.

        Returns the time of the monotonic clock at which it was due; False where it is not to be
        played any more, and None where a second has passed. A moment that is late by more than
        ``LONGEST_DELAY_S`` is due now.
        """
        with self._changed:
            quiet = time.monotonic() + QUIET_S
            while True:
                now = time.monotonic()
                due = now if self._due is None else self._due + self._step_s(recorded_s)
                if self._closed or self._target_s is not None:
                    return False
                if self._paused and self._steps:
                    self._steps -= 1
                    return self._play(now, captured_ns)
                if not self._paused and now >= due:
                    late = now - due > LONGEST_DELAY_S or not self._rate
                    return self._play(now if late else due, captured_ns)
                if now >= quiet:
                    return None
                self._changed.wait((quiet if self._paused else min(due, quiet)) - now)

    def holds_end(self) -> bool:
        """Wait at the end while it is paused, for a second at the most; returns whether it still
        is, with nowhere to go."""
        with self._changed:
            if self._target_s is None:
                self._steps = 0  # there is nothing to step to
            return not self._changed.wait_for(
                lambda: self._closed or self._target_s is not None or not self._paused, QUIET_S
            )

    def _play(self, due: float, captured_ns: int) -> float:
        self._due, self._captured_ns = due, captured_ns
        return due

    def _step_s(self, recorded_s: float) -> float:
        """Return how long a recorded time span takes here, in seconds."""
        return recorded_s / self._rate if self._rate else 0.0

    def _obey(self, action: str, value: float) -> None:
        match action:
            case "pause":
                self._paused = True
            case "resume":
                self._paused, self._steps = False, 0
            case "step" if self._paused:
                self._steps += 1
            case "step":
                self._paused = True
            case "seek":
                self._go_to(value)
            case "skip":
                here = self._position_s() if self._target_s is None else self._target_s
                self._go_to((here or 0.0) + value)
            case "rate":
                self._rate = value
        if action in ("resume", "rate") and self._due is not None:
            self._due = time.monotonic()

    def _go_to(self, target_s: float) -> None:
        """Go on elsewhere; a paused one shows the moment that is there."""
        self._target_s = min(max(target_s, 0.0), self.length_s)
        self._steps = int(self._paused)

    def _position_s(self) -> float | None:
        return None if self._captured_ns is None else (self._captured_ns - self._begin_ns) / 1e9
