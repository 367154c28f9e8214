"""What a process tells the service manager (systemd) that started it: up, alive, and how it is.

It is systemd's protocol (sd_notify(3)): datagrams to the socket that ``NOTIFY_SOCKET`` names.
Where nothing names one, as in a terminal, nothing is said.
"""

import contextlib
import os
import socket
import time
import weakref
from collections.abc import Callable, Mapping

SOCKET, WATCHDOG_US, WATCHDOG_PID = "NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"
VARIABLES = (SOCKET, WATCHDOG_US, WATCHDOG_PID)
"""Variables by which systemd says where to speak; they are for one process and not its children."""
BEATS = 4
"""Number of times that a living loop is shown within the time after which systemd ends it."""
MOST_STATUS = 500
"""Number of characters of a status that ``systemctl status`` has room for."""


class ServiceManager:
    """Speaks for one process; what the manager cannot take is dropped, and nobody waits for it.

    ``advanced`` is for the loop that does the work, and for nothing else: the watchdog is fed by
    it alone, so that systemd ends a process whose work hangs while its other threads live.
    """

    def __init__(
        self, environment: Mapping[str, str] = os.environ, now: Callable[[], float] = time.monotonic
    ) -> None:
        self._now = now
        self._address = environment.get(SOCKET, "")
        self._every_s = _watchdog_s(environment) / BEATS
        self._next_beat = float("inf") if self._every_s == 0.0 else 0.0
        self._is_up = not self._address
        self._status = ""
        # One for all time: a process that has too many files open still has to show that it lives.
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) if self._address else None
        if self._socket is not None:
            self._socket.setblocking(False)
            weakref.finalize(self, self._socket.close)

    def advanced(self) -> None:
        """Note that the work came round: the first time the service is up, then it is alive."""
        if not self._is_up:
            self._is_up = True
            self._send("READY=1")
        if (now := self._now()) >= self._next_beat:
            self._next_beat = now + self._every_s
            self._send("WATCHDOG=1")

    def status(self, words: str) -> None:
        """Say in words how the service is; what was said last is not said again."""
        words = " ".join(words.split())[:MOST_STATUS]
        if words != self._status:
            self._status = words
            self._send(f"STATUS={words}")

    def stopping(self) -> None:
        """Say that the service ends from here on."""
        self._send("STOPPING=1")

    def _send(self, text: str) -> None:
        if self._socket is None:
            return
        # A name that begins with @ is one that no file stands for: the kernel's has a zero.
        name = self._address.encode()
        name = b"\0" + name[1:] if name[:1] == b"@" else name
        with contextlib.suppress(OSError):
            self._socket.sendto(text.encode(), name)


def without_manager(environment: Mapping[str, str]) -> dict[str, str]:
    """Return the environment of a child, which does not speak for its parent."""
    return {name: value for name, value in environment.items() if name not in VARIABLES}


def _watchdog_s(environment: Mapping[str, str]) -> float:
    """Seconds without a sign of life after which this process is ended; 0 where it never is."""
    microseconds = environment.get(WATCHDOG_US, "")
    meant = environment.get(WATCHDOG_PID, str(os.getpid())) == str(os.getpid())
    return int(microseconds) / 1e6 if meant and microseconds.isdecimal() else 0.0
