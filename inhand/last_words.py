"""How a process ended, in words: by which signal or exit code, and what it said last."""

import contextlib
import signal
import sys
import threading
from typing import IO

FOLLOWED_S = 1.0
"""Seconds in which what a process wrote before its end is read to its end; one that left children
behind keeps the pipe open."""


class Told:
    """Passes on what a process writes to its standard error, and remembers the last line."""

    def __init__(self, stream: IO[bytes]) -> None:
        self._last = b""
        self._thread = threading.Thread(target=self._pass_on, args=(stream,), daemon=True)
        self._thread.start()

    def last_line(self) -> str:
        """The last line that was not blank, of a process that has ended."""
        self._thread.join(FOLLOWED_S)
        return self._last.decode(errors="replace").strip()

    def _pass_on(self, stream: IO[bytes]) -> None:
        with stream:
            for line in stream:
                with contextlib.suppress(OSError):  # nobody reads here, and the process must go on
                    sys.stderr.buffer.write(line)
                    sys.stderr.buffer.flush()
                if line.strip():
                    self._last = line


def how_it_ended(code: int, last_line: str) -> str:
    """Say how a process ended, by its return code, negative for a signal, and its last line."""
    if code == 0:
        return "ended with exit code 0"
    if code == -signal.SIGKILL:
        return (
            "was killed by SIGKILL: by somebody, or by the system for lack of memory "
            "(`journalctl -k` says which)"
        )
    if code < 0:
        return f"was killed by {signal.Signals(-code).name}"
    return f"ended with exit code {code}" + (f": {last_line}" if last_line else "")
