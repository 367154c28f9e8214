"""Who edits a file: one at a time, among all tabs and studios.

The claim is a lock file beside it, locked while its holder lives: the system takes the lock away
from whoever crashes or is killed. Who takes over puts another lock file in its place, which the one
before sees before it writes.
"""

import contextlib
import fcntl
import os
from collections.abc import Iterator
from pathlib import Path

from inhand_lab.labelling.keyframes import LabellingError
from inhand_runtime.locked_folder import locked_folder


class Claim:
    """The right to write one file."""

    def __init__(self, lock: Path, descriptor: int) -> None:
        self._lock = lock
        self._descriptor: int | None = descriptor

    @property
    def mine(self) -> bool:
        """Whether nobody took over."""
        return self._descriptor is not None and _is_at(self._descriptor, self._lock)

    @contextlib.contextmanager
    def held(self) -> Iterator[None]:
        """Keep others from taking over while the block runs; raises LabellingError where somebody
        did already."""
        with locked_folder(self._lock.parent):
            if not self.mine:
                raise LabellingError(
                    "another tab or studio has taken over: take over again, or leave it to that one"
                )
            yield

    def release(self) -> None:
        """Let others write."""
        if self._descriptor is None:
            return
        with contextlib.suppress(OSError), locked_folder(self._lock.parent):
            if self.mine:
                self._lock.unlink()
        os.close(self._descriptor)
        self._descriptor = None


def claim(path: Path, *, take_over: bool = False) -> Claim | None:
    """Claim a file, which need not exist; None where somebody else has it.

    ``take_over`` takes it from whoever has it. Raises LabellingError where the folder cannot be
    written to.
    """
    lock = lock_path(path)
    try:
        with locked_folder(lock.parent):
            return _claim(lock, take_over)
    except OSError as error:
        raise LabellingError(
            f"cannot write to {lock.parent}: {error.strerror}; keyframes are kept there: make it "
            "writable, or make room"
        ) from None


def lock_path(path: Path) -> Path:
    """Return the name of a file's lock file."""
    return path.with_name(f".{path.name}.lock")


def _claim(lock: Path, take_over: bool) -> Claim | None:
    descriptor = os.open(lock, os.O_RDWR | os.O_CREAT, 0o600)
    if _locked(descriptor):
        return Claim(lock, descriptor)
    os.close(descriptor)
    if not take_over:
        return None
    lock.unlink()
    descriptor = os.open(lock, os.O_RDWR | os.O_CREAT | os.O_EXCL, 0o600)
    _locked(descriptor)
    return Claim(lock, descriptor)


def _locked(descriptor: int) -> bool:
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def _is_at(descriptor: int, path: Path) -> bool:
    """Whether an open file is the one of that name."""
    mine = os.fstat(descriptor)
    try:
        there = path.stat()
    except FileNotFoundError:
        return False
    return (mine.st_ino, mine.st_dev) == (there.st_ino, there.st_dev)
