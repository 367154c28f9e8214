"""One file under way: what it holds, what of it stands only in memory, and when it is full."""

import contextlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from inhand_runtime.recording import RecordingError, RecordingWriter
from inhand_runtime.recording.part_file import PART_SUFFIX, no_room

from inhand_recorder.attachments import attach_mesh
from inhand_recorder.clock import CLOCK_RECORD, format_clock_steps
from inhand_recorder.losses import LOSSES_RECORD, LossCounter, format_losses


@dataclass(frozen=True)
class CodedEntry:
    """A frame with its colour as H.264: a payload with the digest of the picture, and of the one
    that it ``builds_on``; ``missed`` is to be called where that is not in the file."""

    payload: bytes
    digest: int
    builds_on: int | None
    missed: Callable[[], None]


@dataclass(frozen=True)
class Entry:
    """One encoded message; times are nanoseconds since the epoch.

    A ``kept`` one (calibration, say) belongs at the start of every later file. One that cannot be
    decoded is kept ``apart`` from what readers find under its key. A frame may be ``coded`` beside,
    which is written in place of ``payload`` where the file has what it builds on.
    """

    key: str
    payload: bytes
    received_ns: int
    captured_ns: int
    sequence: int
    kept: bool = False
    apart: bool = False
    coded: CodedEntry | None = None


@dataclass(frozen=True)
class Limits:
    """When a file is big enough, in bytes and seconds; 0 = never."""

    split_bytes: int = 0
    split_seconds: float = 0.0


@dataclass(frozen=True)
class FileHandling:
    """What is the same for all files of a recorder.

    Each begins with the named ``records``, and ends with those that are others by then; ``meshes``
    are attached by the names of their objects. ``make_room`` makes room on a full disk, where it
    can, and ``unwritten`` says how many messages of each key the disk was to blame for so far.
    """

    records: Callable[[], Mapping[str, Mapping[str, str]]] = dict
    make_room: Callable[[], bool] = no_room
    unwritten: Callable[[], Mapping[str, int]] = dict
    meshes: Callable[[], Mapping[str, bytes]] = dict


PLAIN_FILES = FileHandling()
"""Files without records of their own, that fail on a full disk."""


class RecordingFile:
    """Writes entries and counts losses.

    Every method but ``give_up`` and ``discard`` raises RecordingError.
    It is ``worth_keeping`` as soon as the disk holds an entry that memory does not.
    """

    def __init__(
        self,
        path: Path,
        opened_s: float,
        make_room: Callable[[], bool] = no_room,
        former: Mapping[str, int] | None = None,
    ) -> None:
        """``former`` are the latest numbers in the file before, by key."""
        self.path = path
        self._part = path.with_name(path.name + PART_SUFFIX)
        self._opened_s = opened_s
        self._clock_steps: dict[int, int] = {}
        self._losses = LossCounter(former)
        self._in_memory: list[Entry] = []
        self._noted: dict[str, dict[str, str]] = {}
        self._pictures: dict[str, int] = {}
        self.worth_keeping = False
        try:
            self._writer = RecordingWriter(path, make_room=make_room)
        except RecordingError as error:
            if isinstance(error.__cause__, OSError):
                self._remove_part()
            raise

    @property
    def bytes_written(self) -> int:
        """The size of the file so far, without what stands only in memory."""
        return self._writer.bytes_written

    @property
    def latest(self) -> Mapping[str, int]:
        """The latest number by key."""
        return self._losses.latest

    def full(self, limits: Limits, now_s: float) -> bool:
        """Whether it has reached a limit; ``now_s`` is of the clock that ``opened_s`` is of."""
        by_size = 0 < limits.split_bytes <= self.bytes_written
        by_time = 0 < limits.split_seconds <= now_s - self._opened_s
        return by_size or by_time

    def note_clock_step(self, at_ns: int, step_ns: int) -> None:
        """Write that the wall clock was set at a time, and by how much."""
        self._clock_steps[at_ns] = step_ns
        self._writer.add_metadata(CLOCK_RECORD, format_clock_steps(self._clock_steps))

    def note(self, name: str, values: Mapping[str, str]) -> None:
        """Write a named record about the recording; a later one of that name replaces it."""
        self._writer.add_metadata(name, values)

    def note_all(self, records: Mapping[str, Mapping[str, str]]) -> None:
        """Write those of the named records that do not stand in the file yet."""
        for name, values in records.items():
            if self._noted.get(name) != values:
                self.note(name, values)
                self._noted[name] = dict(values)

    def introduce(self, handling: FileHandling, now_ns: int) -> None:
        """Write what each file of a recorder begins with."""
        self.note_all(handling.records())
        for name, data in handling.meshes().items():
            attach_mesh(self._writer, name, data, now_ns)

    def repeat(self, entry: Entry, received_ns: int) -> None:
        """Add an entry of before this file, as if it were received with the file's first one."""
        self._write(replace(entry, received_ns=received_ns))

    def put(self, entry: Entry) -> None:
        """Add an entry; it stands in memory until its chunk is full, or until ``sync``."""
        self._in_memory.append(entry)
        before = self._writer.bytes_written
        self._write(entry)
        if self._writer.bytes_written > before and len(self._in_memory) > 1:
            # The chunk that went to the file may or may not hold the newest entry.
            del self._in_memory[:-1]
            self.worth_keeping = True

    def hand_over(self) -> None:
        """Give everything to the system, so that the end of this process takes nothing with it."""
        self._writer.hand_over()
        self.worth_keeping = True
        self._in_memory.clear()

    def sync(self) -> None:
        """Bring everything to the disk, and make sure that the file is still there."""
        self._writer.sync()
        self.worth_keeping = True
        self._require_part()
        self._in_memory.clear()

    def _require_part(self) -> None:
        try:
            self._part.stat()
        except OSError as error:
            raise RecordingError(
                f"{self._part} was removed while it was written ({error.strerror}): "
                "bring its disk or folder back; a new file is begun"
            ) from error

    def finish(
        self, dropped: Mapping[str, int], unwritten: Mapping[str, int] | None = None
    ) -> Path:
        """Write the losses (with the drops of a queue by key, and those for which the disk was to
        blame), bring everything to the disk, and give the file its name."""
        self._require_part()
        losses = self._losses.losses(dropped, unwritten)
        self._writer.add_metadata(LOSSES_RECORD, format_losses(losses))
        return self._writer.close()

    def give_up(self) -> list[Entry]:
        """Close a file that failed, and return what would be lost otherwise.

        The ``.part`` stays, except when it is not ``worth_keeping``.
        """
        with contextlib.suppress(RecordingError):  # it failed already, and says so again
            self._writer.close()
        if not self.worth_keeping:
            self._remove_part()
        return self._in_memory

    def discard(self) -> None:
        """Close the file and remove all of it, whether it failed or not."""
        self._writer.abandon()
        self._remove_part()

    def _remove_part(self) -> None:
        with contextlib.suppress(OSError):  # then a file stays that holds nothing
            self._part.unlink()

    def _write(self, entry: Entry) -> None:
        if entry.apart:
            self._writer.write_apart(entry.key, entry.payload, received_ns=entry.received_ns)
            return
        self._losses.count(entry.key, entry.sequence)
        self._writer.write(
            entry.key,
            self._payload(entry),
            received_ns=entry.received_ns,
            captured_ns=entry.captured_ns,
            sequence=entry.sequence,
        )

    def _payload(self, entry: Entry) -> bytes:
        """Return what is written of an entry, so that the file can be read by itself."""
        coded = entry.coded
        if coded is None:
            return entry.payload
        if coded.builds_on not in (None, self._pictures.get(entry.key)):
            coded.missed()
            return entry.payload
        self._pictures[entry.key] = coded.digest
        return coded.payload
