"""How much is kept of a folder of recordings: quotas, and what is deleted to hold them."""

import contextlib
import logging
import os
import re
import shutil
import stat
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from inhand_runtime.recording.part_file import PART_SUFFIX
from inhand_runtime.wording import counted, sized
from mcap.records import Header, Metadata
from mcap.writer import MCAP0_MAGIC

from inhand_recorder.clips import CLIPS_FOLDER
from inhand_recorder.file_names import SUFFIX
from inhand_recorder.provenance import RECORDER_RECORD
from inhand_recorder.quotas import FILES_WITHIN, SMALLEST_FILE_BYTES, Quotas
from inhand_recorder.records import length_at, record_at

log = logging.getLogger(__name__)

DAY_NS = 86_400 * 1_000_000_000
HEAD_BYTES = 1 << 18
"""Bytes at the begin of a file in which a recorder says that it is its."""
STEADY_S = 3600.0
"""Seconds that the wall clock must have run without being set before age makes anything go: one
that starts wrong, or is set far ahead by mistake, would cost everything."""
SET_S = 60.0
"""Seconds by which the wall clock leaves the other one when it was set, and not only corrected."""
ROOM_TO_RESUME = 1.1
"""Factor on the floor of free space from which on recording goes on: else it would stop again at
once."""

_NAME = re.compile(r"[a-z0-9_]+_(\d{8}T\d{6}Z)(?:_(\d+))?" + re.escape(SUFFIX))


@dataclass(frozen=True, order=True)
class _Recording:
    """A whole file; ``began_ns`` is what its name says, ``written_ns`` when it was last changed."""

    began_ns: int
    number: int
    path: Path
    size: int
    written_ns: int


@dataclass(frozen=True)
class Untouched:
    """Number and bytes of files that no quota deletes."""

    files: int = 0
    bytes: int = 0


class Retention:
    """Deletes the oldest recordings of a folder while a quota is not held.

    Only whole files that a recorder of Inhand has written into the folder itself are deleted, never
    one that grows, and nothing in folders below it. ``on_delete`` gets each that is gone, its
    size and why.
    """

    def __init__(
        self,
        folder: Path,
        quotas: Quotas,
        on_delete: Callable[[Path, int, str], None],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """``clock`` gives seconds, and nobody sets it."""
        self._folder = folder
        self._clock = clock
        self._wall_offset_s = 0.0
        self._steady_from_s = clock()
        self._quotas = quotas
        self._on_delete = on_delete
        self.problem: str | None = None
        """Why a quota is not held, by the last look."""
        self.deleted = 0
        """Number of recordings deleted so far."""
        self.folder_bytes = 0
        """Bytes of the folder's recordings, those that grow among them, by the last look."""
        self.foreign = Untouched()
        """Recordings in the folder that count and are not deleted, as no recorder of this release
        or a later one has written them under the name that it gave them, by the last look."""
        self.clips = Untouched()
        """Clips, which do not count and are not deleted, by the last look."""
        self._ours: dict[_Recording, bool | None] = {}

    @property
    def free_bytes(self) -> int:
        """Bytes of the disk that are free now; 0 where that cannot be known."""
        with contextlib.suppress(OSError):
            return shutil.disk_usage(self._existing()).free
        return 0

    def file_limit(self) -> int:
        """Bytes after which a new file has to begin, so that quotas can be held; 0 is never."""
        rooms = []
        if self._quotas.keep_bytes:
            rooms.append(self._quotas.keep_bytes)
        if self._quotas.when_full == "delete-oldest":
            rooms.append(self.free_bytes + self.folder_bytes - self._quotas.free_bytes)
        return max(min(rooms) // FILES_WITHIN, SMALLEST_FILE_BYTES) if rooms else 0

    def too_full(self, *, stopped: bool) -> str | None:
        """Why nothing may be written now, where the disk is so full that recording is to stop; one
        that has ``stopped`` needs some more room to go on."""
        floor = self._quotas.free_bytes
        if not floor or self._quotas.when_full != "stop":
            return None
        if self.free_bytes >= floor * (ROOM_TO_RESUME if stopped else 1.0):
            return None
        return (
            f"less than {sized(floor)} of the disk of {self._folder} are free (free_bytes): make "
            "room; until then what arrives waits in memory"
        )

    def short(self) -> bool:
        """Whether recordings have to be deleted now, since the disk is nearly full."""
        quotas = self._quotas
        return quotas.when_full == "delete-oldest" and self.free_bytes < quotas.free_bytes

    def tidy(self, now_ns: int) -> None:
        """Delete what has to go, and note as the ``problem`` what could not."""
        self.problem, failure = None, None
        foreign_before = self.foreign
        self._look_at_clock(now_ns)
        for recording in self._look():
            if (why := self._why(recording, now_ns)) is not None:
                failure = self._delete(recording, why) or failure
        if self._deletes and self.foreign.files > foreign_before.files:
            self._say_what_is_left_out()
        self.problem = failure or self._unheld()

    def _say_what_is_left_out(self) -> None:
        """Log how many recordings no quota deletes; whoever sets one does not expect that."""
        log.warning(
            "no quota deletes %s in %s (%s): an earlier release or another program has written "
            "them, or they were renamed",
            counted(self.foreign.files, "recording"),
            self._folder,
            sized(self.foreign.bytes),
        )

    def _look_at_clock(self, now_ns: int) -> None:
        """Note since when nobody has set the wall clock."""
        now_s = self._clock()
        offset_s = now_ns / 1e9 - now_s
        if abs(offset_s - self._wall_offset_s) > SET_S:
            self._steady_from_s = now_s
        self._wall_offset_s = offset_s

    @property
    def _deletes(self) -> bool:
        """Whether any quota makes something go."""
        quotas = self._quotas
        return bool(quotas.keep_bytes or quotas.keep_days or quotas.when_full == "delete-oldest")

    def _unheld(self) -> str | None:
        """Why a quota is not held, though nothing is left to delete."""
        if self._quotas.keep_bytes and self.folder_bytes > self._quotas.keep_bytes:
            return (
                f"files in {self._folder} take more than {sized(self._quotas.keep_bytes)} "
                "(keep_bytes), and no other may be deleted: recover or move away what is left of "
                "crashes, and what earlier releases have written or others have put there"
            )
        if self._quotas.keep_bytes and self.clips.bytes > self._quotas.keep_bytes:
            return (
                f"clips in {self._folder / CLIPS_FOLDER} take more than "
                f"{sized(self._quotas.keep_bytes)} (keep_bytes), and no quota deletes them: move "
                "away those that are not needed"
            )
        if self.short():
            return (
                f"less than {sized(self._quotas.free_bytes)} of the disk of {self._folder} are "
                "free (free_bytes), and no recording is left to delete: make room"
            )
        return None

    def make_room(self) -> bool:
        """Delete at least one recording, where the disk is full and the oldest shall go; returns
        whether one could be."""
        if self._quotas.when_full != "delete-oldest":
            return False
        before = self.deleted
        self.tidy(time.time_ns())
        for recording in self._look():
            if self.deleted > before:
                break
            self._delete(recording, "the disk is full")
        return self.deleted > before

    def _why(self, recording: _Recording, now_ns: int) -> str | None:
        """Why a recording has to go when all older ones had their turn; None where it may stay."""
        quotas = self._quotas
        age_ns = now_ns - max(recording.began_ns, recording.written_ns)
        is_steady = self._clock() - self._steady_from_s >= STEADY_S
        if quotas.keep_days and is_steady and age_ns > quotas.keep_days * DAY_NS:
            return f"it is older than {quotas.keep_days:g} days"
        if quotas.keep_bytes and self.folder_bytes > quotas.keep_bytes:
            return f"recordings take more than {sized(quotas.keep_bytes)}"
        if self.short():
            return f"less than {sized(quotas.free_bytes)} of the disk are free"
        return None

    def _delete(self, recording: _Recording, why: str) -> str | None:
        """Delete a recording, unless it is none of a recorder's any more; returns what failed."""
        if not _written_by_recorder(recording.path):
            return None
        try:
            recording.path.unlink()
        except OSError as error:
            return f"cannot delete {recording.path}: {error.strerror}"
        self.folder_bytes -= recording.size
        self.deleted += 1
        self._on_delete(recording.path, recording.size, why)
        return None

    def _look(self) -> list[_Recording]:
        """Return the whole files of recorders, the oldest first, and note what all files take."""
        named: list[_Recording] = []
        total = others = foreign_bytes = 0
        for path, status in _files(self._folder):
            total += status.st_size
            recording = _named_recording(path, status)
            if recording is not None:
                named.append(recording)
            elif path.suffix == SUFFIX:
                others += 1
                foreign_bytes += status.st_size
        # A file's begin is read once, as there may be thousands of them.
        before = self._ours
        self._ours = {one: before.get(one, None) for one in named}
        for one, ours in self._ours.items():
            if ours is None:
                self._ours[one] = _written_by_recorder(one.path)
        foreign = [one.size for one, ours in self._ours.items() if not ours]
        self.folder_bytes = total
        self.foreign = Untouched(others + len(foreign), foreign_bytes + sum(foreign))
        clips = [status.st_size for _, status in _files(self._folder / CLIPS_FOLDER)]
        self.clips = Untouched(len(clips), sum(clips))
        return sorted(one for one, ours in self._ours.items() if ours)

    def _existing(self) -> Path:
        """The folder, or the one in which it would be made."""
        folder = self._folder
        while not folder.exists() and folder != folder.parent:
            folder = folder.parent
        return folder


def _files(folder: Path) -> Iterator[tuple[Path, os.stat_result]]:
    """Yield the recordings in a folder, whole ones and others."""
    with contextlib.suppress(OSError):
        for path in folder.iterdir():
            if path.name.endswith((SUFFIX, SUFFIX + PART_SUFFIX)):
                with contextlib.suppress(OSError):  # it was renamed meanwhile
                    status = path.lstat()
                    if stat.S_ISREG(status.st_mode):
                        yield path, status


def _named_recording(path: Path, status: os.stat_result) -> _Recording | None:
    """Return a whole file that has a name as a recorder gives; None of others."""
    match = _NAME.fullmatch(path.name)
    if match is None:
        return None
    began = datetime.strptime(match[1], "%Y%m%dT%H%M%SZ").replace(tzinfo=UTC)
    began_ns, number = int(began.timestamp()) * 1_000_000_000, int(match[2] or 1)
    return _Recording(began_ns, number, path, status.st_size, status.st_mtime_ns)


def _written_by_recorder(path: Path) -> bool | None:
    """Whether a recorder says, at the begin of a file, that it is its; None where that cannot be
    read."""
    try:
        with path.open("rb") as file:
            head = file.read(HEAD_BYTES)
    except OSError:
        return None
    offset = len(MCAP0_MAGIC)
    while isinstance(record := record_at(head, offset), Header | Metadata):
        if isinstance(record, Metadata) and record.name == RECORDER_RECORD:
            return True
        offset += length_at(head, offset)
    return False
