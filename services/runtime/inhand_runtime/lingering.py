"""TCP sockets that close at once, whatever the other end has not taken yet.

Zenoh lets its sockets linger (seen with 1.10.2): closing the link to somebody who stands still
holds one of its threads for 10 s, and with it whatever that thread was about to send to others;
their links, with nothing wrong, may then be closed too. The settings of Zenoh do not reach it.
"""

import contextlib
import os
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
            with contextlib.suppress(OSError):  # the link is gone by now
                _let_not_linger(one.fd)


def _let_not_linger(number: int) -> None:
    with socket.socket(fileno=os.dup(number)) as own:
        own.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, _DO_NOT_LINGER)
