"""A verb of Inhand that a page runs in a process of its own, which can be ended at any time."""

import os
import signal
import subprocess
import sys
import threading
from collections import deque
from collections.abc import Sequence

MOST_LINES = 200
"""Number of a verb's newest lines that are kept."""
KILLED_AFTER_S = 10.0
"""Seconds after which a process that was told to end is killed."""


class Verb:
    """Runs ``inhand VERB …``, and keeps what it says; thread-safe.

    It ends with the studio too, by the signal ``bound``.
    """

    def __init__(self, arguments: Sequence[str], bound: signal.Signals = signal.SIGTERM) -> None:
        """Start it; raises OSError where no process can be made."""
        self._lines: deque[str] = deque(maxlen=MOST_LINES)
        self._process: subprocess.Popen[str] | None = None
        self._failure: OSError | None = None
        started = threading.Event()
        self._thread = threading.Thread(
            target=self._run, args=(list(arguments), bound, started), name=f"verb {arguments[0]}"
        )
        self._thread.daemon = True
        self._thread.start()
        started.wait()
        if self._failure is not None:
            raise self._failure

    @property
    def lines(self) -> tuple[str, ...]:
        """What it said so far, the newest last."""
        return tuple(self._lines)

    @property
    def running(self) -> bool:
        """Whether it has not ended, or not all that it said is read."""
        return self._thread.is_alive()

    @property
    def code(self) -> int | None:
        """Its exit code; None while it runs."""
        return None if self.running or self._process is None else self._process.returncode

    def ended(self, timeout_s: float) -> bool:
        """Wait for its end, for a time; whether it has come."""
        self._thread.join(timeout_s)
        return not self.running

    def interrupt(self) -> None:
        """Let it end as at Ctrl-C, which for a recording is its usual end."""
        self._send(signal.SIGINT)

    def end(self) -> None:
        """Let it end without a result; killed where it does not."""
        self._send(signal.SIGTERM)
        self._thread.join(KILLED_AFTER_S)
        self._send(signal.SIGKILL)

    def _send(self, number: signal.Signals) -> None:
        if self._process is not None and self._process.poll() is None:
            os.killpg(self._process.pid, number)

    def _run(self, arguments: list[str], bound: int, started: threading.Event) -> None:
        own = [str(os.getpid()), str(int(bound))]
        command = [sys.executable, "-m", "inhand_studio.bound_verb", *own, *arguments]
        try:
            self._process = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                errors="replace",
                process_group=0,
            )
        except OSError as error:
            self._failure = error
        finally:
            started.set()
        if self._process is None or self._process.stdout is None:
            return
        with self._process.stdout as said:
            for line in said:
                self._lines.append(line.rstrip())
        self._process.wait()
