"""One recording after the other, and what a failing disk costs: nothing that was received.

What stands only in memory when a file fails goes first into the next one.
"""

import contextlib
import time
from collections import Counter, deque
from collections.abc import Callable, Iterator, Mapping
from datetime import UTC, datetime
from pathlib import Path

from inhand_runtime.recording import RecordingError

from inhand_recorder.recording_file import Entry, Limits, RecordingFile

SUFFIX = ".mcap"


class Journal:
    """Writes entries into files ``{rig}_{UTC time}.mcap`` of a folder, from one thread.

    ``write``, ``sync`` and ``close`` raise RecordingError; the next call then begins another
    file, and ``waiting`` entries go into it. ``dropped`` says how many messages of each key were
    lost so far in a queue before the journal. How long a file lasts is measured by the ``clock``,
    in seconds, which nobody sets.
    """

    def __init__(
        self,
        folder: Path,
        rig: str,
        limits: Limits,
        dropped: Callable[[], Mapping[str, int]],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._folder = folder
        self._rig = rig
        self._limits = limits
        self._dropped = dropped
        self._clock = clock
        self._dropped_before: Mapping[str, int] = {}
        self._waiting: deque[Entry] = deque()
        self._kept: dict[str, Entry] = {}
        self._file: RecordingFile | None = None

    @property
    def waiting(self) -> Counter[str]:
        """How many messages of each key a failed file gave back, until the next call."""
        return Counter(entry.key for entry in self._waiting)

    def write(self, entry: Entry) -> None:
        """Add an entry, in a new file when this one has reached a limit."""
        self._waiting.append(entry)
        self._write_waiting()

    def note_clock_step(self, at_ns: int, step_ns: int) -> None:
        """Write into the file that the wall clock was set, and by how much, in nanoseconds."""
        if self._file is not None:
            with self._giving_up_on_failure(self._file):
                self._file.note_clock_step(at_ns, step_ns)

    def sync(self) -> None:
        """Bring everything to the disk."""
        self._write_waiting()
        if self._file is not None:
            with self._giving_up_on_failure(self._file):
                self._file.sync()

    def close(self) -> None:
        """Finish the file, if there is one; a later ``write`` begins another."""
        self.sync()
        if self._file is not None:
            self._finish(self._file)

    def _write_waiting(self) -> None:
        while self._waiting:
            file = self._file_at(self._waiting[0].received_ns)
            entry = self._waiting.popleft()
            with self._giving_up_on_failure(file):
                file.put(entry)
            if entry.kept:
                self._kept[entry.key] = entry

    def _file_at(self, now_ns: int) -> RecordingFile:
        if self._file is not None and self._file.full(self._limits, self._clock()):
            self._finish(self._file)
        if self._file is None:
            self._file = self._begin(now_ns)
        return self._file

    def _begin(self, now_ns: int) -> RecordingFile:
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise RecordingError(
                f"cannot create {self._folder}: {error.strerror}: bring its disk or folder back"
            ) from error
        try:
            file = RecordingFile(self._free_path(now_ns), self._clock())
        except RecordingError as error:
            raise self._left_no_file(error) from error.__cause__
        with self._giving_up_on_failure(file):
            for entry in self._kept.values():
                if entry not in self._waiting:
                    file.repeat(entry, now_ns)
        return file

    def _finish(self, file: RecordingFile) -> None:
        dropped = Counter(self._dropped())
        with self._giving_up_on_failure(file):
            file.finish(dropped - Counter(self._dropped_before))
        self._dropped_before = dropped
        self._file = None

    @contextlib.contextmanager
    def _giving_up_on_failure(self, file: RecordingFile) -> Iterator[None]:
        try:
            yield
        except RecordingError as error:
            self._file = None
            self._waiting.extendleft(reversed(file.give_up()))
            if file.worth_keeping:
                raise
            raise self._left_no_file(error) from error.__cause__

    def _left_no_file(self, error: RecordingError) -> RecordingError:
        if not isinstance(error.__cause__, OSError):
            return error
        return RecordingError(
            f"cannot write to {self._folder}: {error.__cause__.strerror}: make room or use another "
            "disk; until then what arrives waits in memory"
        )

    def _free_path(self, now_ns: int) -> Path:
        began = datetime.fromtimestamp(now_ns / 1e9, UTC).strftime("%Y%m%dT%H%M%SZ")
        name, number = f"{self._rig}_{began}", 1
        while any(self._folder.glob(f"{name}{SUFFIX}*")):
            number += 1
            name = f"{self._rig}_{began}_{number}"
        return self._folder / f"{name}{SUFFIX}"
