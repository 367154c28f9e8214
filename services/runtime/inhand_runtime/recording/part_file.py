"""A file that grows as ``NAME.part`` and gets its name when it is whole."""

import ctypes
import errno
import os
from collections.abc import Callable
from pathlib import Path

PART_SUFFIX = ".part"
_MOST_PARTS = os.sysconf("SC_IOV_MAX")
"""Number of parts that the system takes in one call."""
_UNSENT_BYTES = 8 << 20
"""Bytes after which the system is asked to bring them to the disk, so that a sync waits for less;
a rig writes as much in two seconds, and is synced before."""
_SYNC_FILE_RANGE_WRITE = 2
_sync_file_range = getattr(ctypes.CDLL(None), "sync_file_range", None)
if _sync_file_range is not None:  # Linux alone has it
    _sync_file_range.argtypes = (ctypes.c_int, ctypes.c_int64, ctypes.c_int64, ctypes.c_uint)


def no_room() -> bool:
    """Make no room on a full disk."""
    return False


class PartFile:
    """Unbuffered, so that a full disk is seen at once and nothing waits to fail later.

    Where the disk is full ``make_room`` is called, and writing goes on as often as it returns True.
    Every method may raise OSError; making one raises FileExistsError when a ``.part`` is there.
    """

    def __init__(
        self, path: Path, suffix: str = PART_SUFFIX, make_room: Callable[[], bool] = no_room
    ) -> None:
        self._path = path
        self._make_room = make_room
        self.part = path.with_name(path.name + suffix)
        self._file = self.part.open("xb", buffering=0)
        self.bytes_written = 0
        self._sent = 0

    @property
    def closed(self) -> bool:
        """Whether nothing can be written any more."""
        return self._file.closed

    def write(self, *parts: bytes) -> None:
        """Write all of the parts, one behind the other, or as much as fits before raising."""
        for start in range(0, len(parts), _MOST_PARTS):
            self._write_all([part for part in parts[start : start + _MOST_PARTS] if part])
        if self.bytes_written - self._sent >= _UNSENT_BYTES:
            self._send()

    def _write_all(self, parts: list[bytes]) -> None:
        while parts:
            try:
                written = os.writev(self._file.fileno(), parts)
            except OSError as error:
                if error.errno == errno.ENOSPC and self._make_room():
                    continue
                raise
            self.bytes_written += written
            parts = _behind(parts, written)

    def _send(self) -> None:
        """Have the system begin to bring all to the disk, and wait for nothing; ``sync`` says what
        failed."""
        if _sync_file_range is not None:
            span = self._sent, self.bytes_written - self._sent
            _sync_file_range(self._file.fileno(), *span, _SYNC_FILE_RANGE_WRITE)
        self._sent = self.bytes_written

    def sync(self) -> None:
        """Bring everything to the disk."""
        os.fdatasync(self._file.fileno())
        self._sent = self.bytes_written

    def close(self) -> None:
        """Close, and leave the ``.part``."""
        self._file.close()

    def publish(self) -> None:
        """Close, and give the file its name, which lasts through a power cut."""
        self.sync()
        self.close()
        self.part.rename(self._path)
        folder = os.open(self._path.parent, os.O_RDONLY | os.O_DIRECTORY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)


def _behind(parts: list[bytes], written: int) -> list[bytes]:
    """Return what is left of parts, of which so many bytes have been written."""
    for number, part in enumerate(parts):
        if written < len(part):
            return [part[written:], *parts[number + 1 :]]
        written -= len(part)
    return []
