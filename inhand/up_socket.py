"""How `inhand reload` reaches the `inhand up` of a settings file, on this machine alone.

It is a socket whose name no file stands for, so that nothing is left of a process that was killed.
It takes requests of the user who runs `inhand up`, and of root.
"""

import contextlib
import hashlib
import json
import os
import socket
import struct
import threading
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

from inhand_runtime.errors import InhandError

ANSWER_S = 120.0
"""Seconds that a reload may take: each process that changed checks its settings before."""
IDLE_S = 5.0
"""Seconds that whoever connects has to say something."""
LARGEST_BYTES = 1 << 16
REQUEST = b"reload"


@dataclass(frozen=True)
class Answer:
    """Whether settings were taken over, and what is said of it, a line each."""

    taken: bool
    lines: tuple[str, ...]


def ask_to_reload(config: Path) -> Answer:
    """Ask the `inhand up` of a settings file; raises InhandError where none runs, or it dies."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as asked:
        asked.settimeout(ANSWER_S)
        try:
            asked.connect(_name(config))
        except OSError:
            raise InhandError(
                f"no `inhand up` runs with {config}: start it; what runs with another file is "
                "reloaded by that file's name"
            ) from None
        try:
            asked.sendall(REQUEST)
            asked.shutdown(socket.SHUT_WR)
            data = b"".join(iter(lambda: asked.recv(LARGEST_BYTES), b""))
            values = json.loads(data)
            return Answer(bool(values["taken"]), tuple(values["lines"]))
        except (OSError, ValueError, KeyError):
            raise InhandError(
                f"the `inhand up` of {config} did not answer: its log says why"
            ) from None


@contextlib.contextmanager
def answering(config: Path, on_request: Callable[[], Answer]) -> Iterator[bool]:
    """Answer requests from a thread until the block ends; gives whether anybody can ask.

    Nobody can where another process has the name.
    """
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as listening:
        try:
            listening.bind(_name(config))
            listening.listen()
        except OSError:
            yield False
            return
        thread = threading.Thread(target=_serve, args=(listening, on_request), daemon=True)
        thread.start()
        try:
            yield True
        finally:
            with contextlib.suppress(OSError):
                listening.shutdown(socket.SHUT_RDWR)


def _serve(listening: socket.socket, on_request: Callable[[], Answer]) -> None:
    while True:
        try:
            asking, _ = listening.accept()
        except OSError:  # the end
            return
        with asking, contextlib.suppress(OSError):
            asking.settimeout(IDLE_S)
            if _user_of(asking) in (0, os.geteuid()) and asking.recv(LARGEST_BYTES) == REQUEST:
                asking.sendall(json.dumps(asdict(on_request())).encode())


def _user_of(asking: socket.socket) -> int:
    kind = "3i"
    given = asking.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, struct.calcsize(kind))
    _, user, _ = struct.unpack(kind, given)
    return int(user)


def _name(config: Path) -> bytes:
    digest = hashlib.sha256(os.fsencode(config.resolve())).hexdigest()[:32]
    return b"\0inhand-up-" + digest.encode()
