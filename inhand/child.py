"""A child process that is started again after a failure, and killed where it hangs."""

import logging
import os
import signal
import subprocess
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from inhand_runtime.exit_codes import DONE, WRONG_USAGE
from inhand_runtime.service_manager import without_manager
from inhand_runtime.supervisor_watch import supervised

from inhand.heartbeats import Heartbeats
from inhand.last_words import Told, how_it_ended

log = logging.getLogger(__name__)

FIRST_RESTART_S, LAST_RESTART_S = 0.1, 30.0
HEALTHY_AFTER_S = 10.0
LOOP_FAILURES = 5
"""Number of ends, each within ``HEALTHY_AFTER_S`` of its start, after which that is an alert."""
HANGS_AFTER_S = 10.0
"""Seconds in which a child's main loop does not come round, after which it is killed and started
again."""
STOP_WITHIN_S = 10.0
"""What a daemon promises (2 s), and time for a busy machine on which it has just begun."""
LONGEST_TICK_S = 1.0


class Child:
    """One process; it is started again after a failure, later each time."""

    def __init__(
        self,
        name: str,
        command: Sequence[str],
        settings: tuple[Any, ...] = (),
        environment: Callable[[], Mapping[str, str]] = dict,
    ) -> None:
        """``environment`` gives what is to be added to this process's own at each start."""
        self.name = name
        self.done = False
        self.command = command
        self.settings = settings
        self._environment = environment
        self._leaves_by = float("inf")
        self._process: subprocess.Popen[bytes] | None = None
        self._start_at = 0.0
        self._delay = FIRST_RESTART_S
        self._told: Told | None = None
        self._failures: list[float] = []
        self._heartbeats: Heartbeats | None = None
        self._silent_s: float | None = None
        self._was_up = False
        self._tended_at = time.monotonic()

    def tend(self) -> int | None:
        """Start the process when its time has come; returns the exit code when it just ended."""
        now = time.monotonic()
        if self._process is None:
            if not self.done and now >= self._start_at:
                self._start_at = now
                self._heartbeats = Heartbeats()
                self._process = subprocess.Popen(
                    self.command,
                    env={
                        **without_manager(os.environ),
                        **self._heartbeats.environment(HANGS_AFTER_S / 10),
                        **self._environment(),
                        **supervised(),
                    },
                    stdin=subprocess.DEVNULL,
                    stderr=subprocess.PIPE,
                    process_group=0,
                )
                assert self._process.stderr is not None
                self._told = Told(self._process.stderr)
            return None
        code = self._process.poll()
        if code is None:
            return None
        self._process = None
        self._hear_no_more()
        # Settings by which it was up were right: a file that they name has changed since.
        self.done = code == DONE or (code == WRONG_USAGE and not self._was_up)
        if self.done:
            log.info("%s ended with exit code %d", self.name, code)
        else:
            self._fail(code, now)
        return code

    def _fail(self, code: int, now: float) -> None:
        """Say how the process ended, and when it is started again."""
        if now - self._start_at > HEALTHY_AFTER_S:
            self._delay = FIRST_RESTART_S
            self._failures.clear()
        last_line = "" if self._told is None else self._told.last_line()
        log.warning(
            "%s %s; starting it again in %g s",
            self.name,
            how_it_ended(code, last_line),
            self._delay,
        )
        self._failures.append(now)
        if len(self._failures) == LOOP_FAILURES:
            log.error(
                "%s has ended %d times in %.0f s, and is started again for ever, each %g s at the "
                "most: mend what it says above",
                self.name,
                LOOP_FAILURES,
                now - self._failures[0],
                LAST_RESTART_S,
            )
        self._start_at = now + self._delay
        self._delay = min(2 * self._delay, LAST_RESTART_S)

    @property
    def is_up(self) -> bool:
        """Whether the work of the process that runs has come round."""
        return self._silent_s is not None

    def kill_if_it_hangs(self) -> None:
        """End the process when its work has come round before and does so no more, for long.

        Only time in which this process itself ran counts: after a suspended night, or on a machine
        that was too busy to let anybody run, all have time to show themselves again.
        """
        now = time.monotonic()
        awake, self._tended_at = min(now - self._tended_at, LONGEST_TICK_S), now
        if self._process is None or self._heartbeats is None:
            self._silent_s = None
        elif self._heartbeats.came_from(self._process.pid):
            self._silent_s, self._was_up = 0.0, True
        elif self._silent_s is not None:
            self._silent_s += awake
            if self._silent_s > HANGS_AFTER_S:
                log.error(
                    "%s has not come round for %.0f s: it hangs, and is killed",
                    self.name,
                    self._silent_s,
                )
                self._silent_s = None
                self._process.kill()

    def leave(self) -> None:
        """Ask the process to end for good."""
        self.done = True
        self._leaves_by = time.monotonic() + STOP_WITHIN_S
        self.send(signal.SIGTERM)

    def has_left(self) -> bool:
        """Whether a process that was asked has ended; one that takes too long is killed."""
        if not self.ended() and time.monotonic() > self._leaves_by:
            log.error("%s did not end by itself: killed", self.name)
            self.kill()
        if self.ended():
            self._hear_no_more()
        return self.ended()

    def send(self, number: int) -> None:
        """Send a signal, when it runs."""
        if self._process is not None:
            self._process.send_signal(number)

    def ended(self) -> bool:
        """Whether no process is left."""
        return self._process is None or self._process.poll() is not None

    def kill(self) -> None:
        """End it at once, and wait until it is gone."""
        if self._process is not None:
            self._process.kill()
            self._process.wait()
        self._hear_no_more()

    def _hear_no_more(self) -> None:
        if self._heartbeats is not None:
            self._heartbeats.close()
            self._heartbeats = None
