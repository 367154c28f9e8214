"""Long work that goes on where it was interrupted: results of its sections wait in a folder."""

import hashlib
import json
import os
import shutil
import struct
from collections.abc import Mapping
from pathlib import Path
from typing import IO

from inhand_runtime.errors import InhandError
from inhand_runtime.recording.opening import opening
from mcap.opcode import Opcode
from mcap.writer import MCAP0_MAGIC

ABOUT = "about.json"
"""The file that says of what inputs and settings the results are."""
_UNFINISHED = ".unfinished"
_FOOTER = struct.Struct("<BQQQI")
_DATA_END = struct.Struct("<BQI")


class SectionResults:
    """The results of the sections of one work, by their names, in a folder of their own.

    A result is there when it is whole, through a power cut too. Those of other inputs or settings
    are deleted. Every method raises InhandError where the disk fails.
    """

    def __init__(self, folder: Path, about: Mapping[str, object]) -> None:
        """Keep what ``folder`` holds of a work ``about`` the same, in JSON; nothing is made before
        the first result. Raises InhandError where the folder is somebody else's."""
        self._folder = folder
        self._about = json.dumps(about, sort_keys=True, indent=1)
        if not folder.exists():
            return
        try:
            former = (folder / ABOUT).read_text()
        except OSError:
            raise InhandError(f"{folder} is in the way: move it, or choose another name") from None
        if former != self._about:
            shutil.rmtree(folder)

    def load(self, name: str) -> bytes | None:
        """Return a result; None where there is none yet."""
        path = self._folder / name
        try:
            return path.read_bytes()
        except FileNotFoundError:
            return None
        except OSError as error:
            raise InhandError(f"cannot read {path}: {error.strerror}") from error

    def store(self, name: str, result: bytes) -> None:
        """Bring a result to the disk."""
        try:
            if not self._folder.exists():
                self._begin()
            _write_whole(self._folder / name, result)
        except OSError as error:
            raise InhandError(
                f"cannot write into {self._folder}: {error.strerror}: make room or choose another "
                "disk; what is done stays there, and the same command goes on"
            ) from error

    def remove(self) -> None:
        """Remove all results, as the work is done."""
        if self._folder.exists():
            shutil.rmtree(self._folder)

    def _begin(self) -> None:
        """Make the folder with what it is about, at once, as one without that is nobody's."""
        begun = self._folder.with_name(self._folder.name + _UNFINISHED)
        if begun.exists():
            shutil.rmtree(begun)
        begun.mkdir(parents=True)
        _write_whole(begun / ABOUT, self._about.encode())
        begun.rename(self._folder)


def digest_of_recording(path: Path) -> str:
    """Return what differs with the contents of a recording: by its own index and the checksum that
    it has of all before, or, where it is not whole or has none, by all bytes.

    Raises RecordingError for a file that is missing.
    """
    with opening(path), path.open("rb") as file:
        place = _end_of_data(file)
        digest = hashlib.sha256(str(file.seek(0, os.SEEK_END)).encode())
        file.seek(place)
        while data := file.read(1 << 20):
            digest.update(data)
    return digest.hexdigest()


def _end_of_data(file: IO[bytes]) -> int:
    """Return where the record with the checksum of all before it stands; 0 where there is none."""
    tail = _FOOTER.size + len(MCAP0_MAGIC)
    size = file.seek(0, os.SEEK_END)
    if size < tail + _DATA_END.size:
        return 0
    file.seek(size - tail)
    opcode, _, summary_start, _, _ = _FOOTER.unpack(file.read(_FOOTER.size))
    place = int(summary_start) - _DATA_END.size
    if file.read() != MCAP0_MAGIC or opcode != Opcode.FOOTER or not 0 < place < size - tail:
        return 0
    file.seek(place)
    opcode, _, checksum = _DATA_END.unpack(file.read(_DATA_END.size))
    return place if opcode == Opcode.DATA_END and checksum else 0


def _write_whole(path: Path, data: bytes) -> None:
    """Write a file that has its name when it is on the disk; raises OSError."""
    growing = path.with_name(path.name + _UNFINISHED)
    with growing.open("wb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())
    growing.rename(path)
