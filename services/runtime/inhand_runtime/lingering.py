"""TCP sockets that close at once, whatever the other end has not taken yet.

Zenoh lets its sockets linger (seen with 1.10.2): closing the link to somebody who stands still
holds one of its threads for 10 s, and with it whatever that thread was about to send to others;
their links, with nothing wrong, may then be closed too. The settings of Zenoh do not reach it.
"""

import contextlib
import re
import socket
import struct

import psutil

_PORT = re.compile(r":(\d+)(?=[?#]|$)")
_DO_NOT_LINGER = struct.pack("ii", 0, 0)


def close_at_once(ends: tuple[str, str]) -> None:
    """Let this process's TCP socket between two addresses (``tcp/HOST:PORT``) linger no longer."""
    ports = tuple(int(port) for end in ends for port in _PORT.findall(end))
    for one in psutil.Process().net_connections("tcp"):
        listens = one.status == psutil.CONN_LISTEN
        if not listens and (one.laddr.port, one.raddr.port) == ports:
            let_not_linger(one.fd, ports)


def let_not_linger(number: int, ports: tuple[int, ...]) -> None:
    """Set it for a descriptor that was a socket between these ports a moment ago.

    The link may be gone by now and its number given to anything: what is no socket, or one between
    other ports, stays as it is. No second descriptor is made, which might outlive a lock's.
    """
    with contextlib.suppress(OSError):  # it is no socket, or none that is connected
        taken = socket.socket(fileno=number)
        try:
            if (taken.getsockname()[1], taken.getpeername()[1]) == ports:
                taken.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, _DO_NOT_LINGER)
        finally:
            taken.detach()
