"""A file that grows as ``NAME.part`` and gets its name when it is whole."""

import errno
import os
from collections.abc import Callable
from pathlib import Path

PART_SUFFIX = ".part"


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

    @property
    def closed(self) -> bool:
        """Whether nothing can be written any more."""
        return self._file.closed

    def write(self, data: bytes) -> int:
        """Write all of ``data``, or as much as fits before raising."""
        rest = memoryview(data)
        while rest:
            try:
                written = self._file.write(rest)
            except OSError as error:
                if error.errno == errno.ENOSPC and self._make_room():
                    continue
                raise
            self.bytes_written += written
            rest = rest[written:]
        return len(data)

    def tell(self) -> int:
        """Where the next byte goes."""
        return self.bytes_written

    def flush(self) -> None:
        """Nothing waits here; the MCAP writer calls it."""

    def sync(self) -> None:
        """Bring everything to the disk."""
        os.fdatasync(self._file.fileno())

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
