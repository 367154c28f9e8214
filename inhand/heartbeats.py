"""Hears on this machine alone, whatever becomes of a network, whether a child's work comes round.

It is systemd's protocol, as ``inhand_runtime.service_manager`` speaks it: the child is told of a
socket of this process.
"""

import contextlib
import socket
import struct
from collections.abc import Mapping

from inhand_runtime.service_manager import BEATS, SOCKET, WATCHDOG_US

LARGEST_BYTES = 4096
CREDENTIALS = struct.Struct("3i")
"""The process, user and group that Linux says sent a datagram."""
SIGNS = {b"READY=1", b"WATCHDOG=1"}
"""What only the loop that does the work says; other words come from other threads."""


class Heartbeats:
    """Hears a child's signs of life, by a socket that no file stands for."""

    def __init__(self) -> None:
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM | socket.SOCK_CLOEXEC)
        self._socket.setblocking(False)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_PASSCRED, 1)
        self._socket.bind(b"")  # Linux finds a name

    def environment(self, every_s: float) -> Mapping[str, str]:
        """Return the variables by which a child shows itself every so many seconds."""
        name = "@" + self._socket.getsockname()[1:].decode()
        return {SOCKET: name, WATCHDOG_US: str(round(BEATS * every_s * 1e6))}

    def came_from(self, process: int) -> bool:
        """Whether a sign of life of a process has come since the last call; others' are nobody's,
        as those of what it has started, which hears of the socket too."""
        came = False
        with contextlib.suppress(BlockingIOError):
            while True:
                data, ancillary, _, _ = self._socket.recvmsg(
                    LARGEST_BYTES, socket.CMSG_SPACE(CREDENTIALS.size)
                )
                came |= data in SIGNS and _sender(ancillary) == process
        return came

    def close(self) -> None:
        """Hear no more."""
        self._socket.close()


def _sender(ancillary: list[tuple[int, int, bytes]]) -> int | None:
    for level, kind, data in ancillary:
        if (level, kind) == (socket.SOL_SOCKET, socket.SCM_CREDENTIALS):
            return int(CREDENTIALS.unpack(data[: CREDENTIALS.size])[0])
    return None
