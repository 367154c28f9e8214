"""Keeps child processes running, and leaves none behind."""

import ctypes
import logging
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from types import FrameType

from inhand_runtime.exit_codes import DONE, FAILED, WRONG_USAGE
from inhand_runtime.service_manager import ServiceManager, without_manager

from inhand.last_words import Told, how_it_ended

log = logging.getLogger(__name__)

TICK_S = 0.05
LONGEST_TICK_S = 1.0
FIRST_RESTART_S, LAST_RESTART_S = 0.5, 30.0
HEALTHY_AFTER_S = 10.0
LOOP_FAILURES = 5
"""Number of ends, each within ``HEALTHY_AFTER_S`` of its start, after which that is an alert."""
UP_WITHIN_S = 20.0
HANGS_AFTER_S = 10.0
"""Seconds without a report of a main loop that came round, after which a child is killed and
started again."""
STOP_WITHIN_S = 10.0
"""What a daemon promises (2 s), and time for a busy machine on which it has just begun."""

_PR_SET_PDEATHSIG = 1


class Child:
    """One process; it is started again after a failure, later each time."""

    def __init__(self, name: str, command: Sequence[str]) -> None:
        self.name = name
        self.done = False
        self.command = command
        self._process: subprocess.Popen[bytes] | None = None
        self._start_at = 0.0
        self._delay = FIRST_RESTART_S
        self._told: Told | None = None
        self._failures: list[float] = []
        self._reports: int | None = None
        self._silent_s: float | None = None
        self._tended_at = time.monotonic()

    def tend(self) -> int | None:
        """Start the process when its time has come; returns the exit code when it just ended."""
        now = time.monotonic()
        if self._process is None:
            if not self.done and now >= self._start_at:
                self._start_at = now
                self._process = subprocess.Popen(
                    self.command,
                    env=without_manager(os.environ),
                    stdin=subprocess.DEVNULL,
                    stderr=subprocess.PIPE,
                    process_group=0,
                    preexec_fn=_ending_with(os.getpid()),
                )
                assert self._process.stderr is not None
                self._told = Told(self._process.stderr)
            return None
        code = self._process.poll()
        if code is None:
            return None
        self._process = None
        self.done = code in (DONE, WRONG_USAGE)
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

    def kill_if_it_hangs(self, reports: int | None, *, can_hear: bool = True) -> None:
        """End the process when it has reported before and does so no more, for long.

        Only time in which this process itself ran counts: after a suspended night, or on a machine
        that was too busy to let anybody run, all have time to speak again. So have they after a
        time in which nothing can be heard, since the hub is away.
        """
        now = time.monotonic()
        awake, self._tended_at = min(now - self._tended_at, LONGEST_TICK_S), now
        if self._process is None:
            self._reports = self._silent_s = None
            return
        if reports is not None and reports != self._reports:
            # What was counted of the process before this one is not this one's report.
            self._silent_s = None if self._reports is None else 0.0
            self._reports = reports
        elif self._silent_s is not None:
            self._silent_s = self._silent_s + awake if can_hear else 0.0
        if self._silent_s is not None and self._silent_s > HANGS_AFTER_S:
            log.error(
                "%s has not come round for %.0f s: it hangs, and is killed",
                self.name,
                self._silent_s,
            )
            self._reports = self._silent_s = None
            self._process.kill()

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


class Supervisor:
    """Runs children until all are done, one has wrong settings, or SIGTERM or SIGINT comes.

    They are stopped stage by stage in the given order, so that what is under way reaches the
    last, and started in reverse: a stage begins when the one after it is up, or has had time
    enough, so that nothing early is missed. ``reports`` says how many reports of its health came
    from a child of that name so far, None while it is not up; a child from which no more come is
    killed, and so started again. ``can_hear`` says whether any could come, as where a hub is up.
    """

    def __init__(
        self,
        stages: Sequence[Sequence[Child]],
        reports: Callable[[str], int | None],
        can_hear: Callable[[], bool],
        manager: ServiceManager | None = None,
    ) -> None:
        self._stages = stages
        self._reports = reports
        self._can_hear = can_hear
        self._manager = ServiceManager() if manager is None else manager
        self._signals = 0

    def run(self) -> int:
        """Exit code 0, 1 when a child had to be killed, or 2 for wrong settings."""
        previous = {
            number: signal.signal(number, self._note) for number in (signal.SIGTERM, signal.SIGINT)
        }
        try:
            code = self._tend()
            return FAILED if not self._stop() and code == DONE else code
        finally:
            for child in self._children():
                child.kill()
            for number, handler in previous.items():
                signal.signal(number, handler)

    def _note(self, _number: int, _frame: FrameType | None) -> None:
        self._signals += 1

    def _children(self) -> list[Child]:
        return [child for stage in reversed(self._stages) for child in stage]

    def _tend(self) -> int:
        waiting, started = list(self._stages), list[Child]()
        deadline = time.monotonic()
        while not self._signals:
            if waiting and (
                all(child.done or self._reports(child.name) is not None for child in started)
                or time.monotonic() > deadline
            ):
                started += waiting.pop()
                deadline = time.monotonic() + UP_WITHIN_S
            can_hear = self._can_hear()
            for child in started:
                if child.tend() == WRONG_USAGE:
                    log.error("%s has wrong settings (see above): stopping everything", child.name)
                    return WRONG_USAGE
                child.kill_if_it_hangs(self._reports(child.name), can_hear=can_hear)
            if not waiting:
                self._report(started)
                if all(child.done for child in started):
                    return DONE
            time.sleep(TICK_S)
        return DONE

    def _report(self, children: Sequence[Child]) -> None:
        """Tell systemd, where it started this process, that all were started, and how many run."""
        running = sum(not child.ended() for child in children)
        self._manager.status(f"{running} of {len(children)} processes run")
        self._manager.advanced()

    def _stop(self) -> bool:
        """Ask all to end; False when one had to be killed. A second signal kills at once."""
        self._manager.stopping()
        signals = self._signals
        all_ended = True
        for stage in self._stages:
            for child in stage:
                child.send(signal.SIGTERM)
            end = time.monotonic() + STOP_WITHIN_S
            while not all(child.ended() for child in stage):
                if time.monotonic() > end or self._signals > signals:
                    break
                time.sleep(TICK_S)
            for child in stage:
                if not child.ended():
                    log.error("%s did not end by itself: killed", child.name)
                    child.kill()
                    all_ended = False
        return all_ended


def _ending_with(parent: int) -> Callable[[], None] | None:
    """What a child does first, so that not even a killed supervisor leaves it behind."""
    if sys.platform != "linux":
        return None
    libc = ctypes.CDLL(None)

    def prepare() -> None:
        libc.prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)
        if os.getppid() != parent:
            os._exit(FAILED)

    return prepare
