"""A replay's bar and keys on a terminal: the one shows where it is, the others move it."""

import contextlib
import os
import select
import signal
import sys
import termios
import threading
import time
import tty
from collections.abc import Iterator
from pathlib import Path

from inhand_schemas.playback import PLAYBACK, PlaybackReply, PlaybackRequest
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn

from inhand.looking import Look, open_look
from inhand.playback import position_line

SKIPPED_S = 5.0
"""Recorded seconds that an arrow to the right goes forward, and one to the left back."""
FASTER = 2.0
"""Factor of the rate by an arrow up, and its divisor by one down."""
LOOK_S = 0.25
"""Seconds between two looks at where it is."""
KEYS = "space: pause  .: step  ←→: 5 s  ↑↓: rate  q: end"
END = b"q"
_ARROWS = {b"\x1b[C": 1.0, b"\x1b[D": -1.0}


@contextlib.contextmanager
def playing_on_terminal(config: Path | None, camera: str, name: str) -> Iterator[None]:
    """Show where a replay is while a block runs, where standard error is a terminal; keys move it
    where standard input is one too."""
    console = Console(stderr=True)
    if not console.is_terminal:
        yield
        return
    ended = threading.Event()
    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.fields[where]}"))
    with _single_keys() as keys, Progress(*columns, console=console) as progress:
        hint = f"replaying {name}  ({KEYS})" if keys is not None else f"replaying {name}"
        task = progress.add_task(hint, total=None, where="")

        def show(reply: PlaybackReply | None) -> None:
            if reply is not None:
                position_s = reply.position_s or 0.0
                where = position_line(reply)
                progress.update(task, total=reply.length_s, completed=position_s, where=where)

        def watch() -> None:
            with open_look(config) as look:
                while not ended.is_set():
                    show(_asked(look, camera, PlaybackRequest(action="status", camera=camera)))
                    until = time.monotonic() + LOOK_S
                    while (rest := until - time.monotonic()) > 0.0 and not ended.is_set():
                        if keys is None:
                            ended.wait(rest)
                        elif (key := _key(keys, rest)) is not None:
                            show(_pressed(look, camera, key))

        watcher = threading.Thread(target=watch, name="terminal")
        watcher.start()
        try:
            yield
        finally:
            ended.set()
            watcher.join()


@contextlib.contextmanager
def _single_keys() -> Iterator[int | None]:
    """Let keys come one by one and unseen while a block runs; None where there is no keyboard."""
    if not sys.stdin.isatty():
        yield None
        return
    descriptor = sys.stdin.fileno()
    before = termios.tcgetattr(descriptor)
    try:
        tty.setcbreak(descriptor)
        yield descriptor
    finally:
        termios.tcsetattr(descriptor, termios.TCSADRAIN, before)


def _key(descriptor: int, seconds: float) -> bytes | None:
    """Wait for a key; an arrow is several bytes at once."""
    ready, _, _ = select.select([descriptor], [], [], seconds)
    return os.read(descriptor, 3) if ready else None


def _pressed(look: Look, camera: str, key: bytes) -> PlaybackReply | None:
    """Do what a key is for."""
    if key == END:
        os.kill(os.getpid(), signal.SIGTERM)
        return None
    now = _asked(look, camera, PlaybackRequest(action="status", camera=camera))
    if now is None:
        return None
    request = _request(key, now)
    return None if request is None else _asked(look, camera, request)


def _request(key: bytes, now: PlaybackReply) -> PlaybackRequest | None:
    """Return what a key asks for, of a replay as it is now; None where it is for nothing."""
    camera = now.camera
    if key == b" ":
        return PlaybackRequest(action="resume" if now.paused else "pause", camera=camera)
    if key == b".":
        return PlaybackRequest(action="step", camera=camera)
    if key in _ARROWS:
        return PlaybackRequest(action="skip", value=SKIPPED_S * _ARROWS[key], camera=camera)
    if key in (b"\x1b[A", b"\x1b[B"):
        factor = FASTER if key == b"\x1b[A" else 1 / FASTER
        return PlaybackRequest(action="rate", value=now.rate * factor, camera=camera)
    return None


def _asked(look: Look, camera: str, request: PlaybackRequest) -> PlaybackReply | None:
    """Ask the replay; None where it does not answer, as before it is up."""
    replies = look.ask(PLAYBACK, request, bool, 0.0)
    return next((one for one in replies if one.camera == camera and one.problem is None), None)
