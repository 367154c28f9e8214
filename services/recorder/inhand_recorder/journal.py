"""One recording after the other, and what a failing disk costs: nothing that was received.

What stands only in memory when a file fails goes first into the next one.
"""

import contextlib
import time
from collections import Counter, deque
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

from inhand_runtime.recording import RecordingError
from inhand_schemas.messages import RecordingState

from inhand_recorder.file_names import free_path
from inhand_recorder.recording_file import PLAIN_FILES, Entry, FileHandling, Limits, RecordingFile

PAUSES_RECORD = "pauses"
"""The name of the metadata record that says when a recorder was paused before or after a file."""


class Journal:
    """Writes entries into files ``{rig}_{UTC time}.mcap`` of a folder, from one thread.

    ``write``, ``sync`` and ``close`` raise RecordingError; the next call then begins another
    file, and ``waiting`` entries go into it. ``dropped`` says how many messages of each key were
    lost so far in a queue before the journal. How long a file lasts is measured by the ``clock``,
    in seconds, which nobody sets. ``files`` says what is the same for all files.

    A pause makes the file whole. It and the next one note the pause, so that nobody takes what is
    missing between them for lost.
    """

    def __init__(
        self,
        folder: Path,
        rig: str,
        limits: Limits,
        dropped: Callable[[], Mapping[str, int]],
        clock: Callable[[], float] = time.monotonic,
        files: FileHandling = PLAIN_FILES,
    ) -> None:
        self._folder = folder
        self._rig = rig
        self._limits = limits
        self._dropped = dropped
        self._clock = clock
        self._handling = files
        self.file_limit = 0
        """Bytes after which a file is finished, beside the limits; 0 is never."""
        self._dropped_before: Counter[str] = Counter()
        self._unwritten_before: Counter[str] = Counter()
        self._waiting: deque[Entry] = deque()
        self._kept: dict[str, Entry] = {}
        self._latest: dict[str, int] = {}
        self._file: RecordingFile | None = None
        self._paused_since_ns: int | None = None
        self._pauses: dict[int, int | None] = {}

    @property
    def paused(self) -> bool:
        """Whether what comes is not written, because somebody wants it so."""
        return self._paused_since_ns is not None

    @property
    def state(self) -> RecordingState:
        """Whether it is paused, and which file grows."""
        if self._file is None:
            return RecordingState(paused=self.paused)
        return RecordingState(
            paused=self.paused, file=self._file.path.name, file_bytes=self._file.bytes_written
        )

    @property
    def waiting(self) -> Counter[str]:
        """How many messages of each key a failed file gave back, until the next call."""
        return Counter(entry.key for entry in self._waiting)

    def write(self, entry: Entry) -> None:
        """Add an entry, in a new file when this one has reached a limit; while paused, only
        remember what later files begin with."""
        if self.paused:
            self._remember(entry)
            return
        self._waiting.append(entry)
        self._write_waiting()

    def pause(self, at_ns: int) -> Path | None:
        """Write nothing from now on; returns the file that is whole now, if one grew."""
        if self.paused:
            return None
        self._paused_since_ns = at_ns
        self._pauses[at_ns] = None
        return self.close()

    def resume(self, at_ns: int) -> None:
        """Write what comes from now on."""
        if self._paused_since_ns is not None:
            self._pauses = {self._paused_since_ns: at_ns}
            self._paused_since_ns = None
            self._latest = {}
            self._dropped_before = Counter(self._dropped())
            self._unwritten_before = Counter(self._handling.unwritten())

    def note_clock_step(self, at_ns: int, step_ns: int) -> None:
        """Write into the file that the wall clock was set, and by how much, in nanoseconds."""
        if self._file is not None:
            with self._giving_up_on_failure(self._file):
                self._file.note_clock_step(at_ns, step_ns)

    def hand_over(self) -> None:
        """Give everything to the system, so that the end of this process takes nothing with it."""
        self._write_waiting()
        if self._file is not None:
            with self._giving_up_on_failure(self._file):
                self._file.hand_over()

    def sync(self) -> None:
        """Bring everything to the disk."""
        if self.paused:
            self.close()
            return
        self._write_waiting()
        if self._file is not None:
            with self._giving_up_on_failure(self._file):
                self._file.sync()

    def close(self) -> Path | None:
        """Finish the file, if there is one, and return it; a later ``write`` begins another."""
        self._write_waiting()
        return None if self._file is None else self._finish(self._file)

    def _write_waiting(self) -> None:
        while self._waiting:
            file = self._file_at(self._waiting[0].received_ns)
            entry = self._waiting.popleft()
            try:  # for each message, so without a context manager
                file.put(entry)
            except RecordingError as error:
                raise self._given_up(file, error) from error.__cause__
            self._remember(entry)

    def _remember(self, entry: Entry) -> None:
        if entry.kept:
            self._kept[entry.key] = entry

    def _file_at(self, now_ns: int) -> RecordingFile:
        if self._file is not None and self._is_full(self._file):
            self._finish(self._file)
        if self._file is None:
            self._file = self._begin(now_ns)
        return self._file

    def _is_full(self, file: RecordingFile) -> bool:
        beyond = 0 < self.file_limit <= file.bytes_written
        return beyond or file.full(self._limits, self._clock())

    def _begin(self, now_ns: int) -> RecordingFile:
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise RecordingError(
                f"cannot create {self._folder}: {error.strerror}: bring its disk or folder back"
            ) from error
        try:
            path = free_path(self._folder, self._rig, now_ns)
            file = RecordingFile(path, self._clock(), self._handling.make_room, self._latest)
        except RecordingError as error:
            raise self._left_no_file(error) from error.__cause__
        with self._giving_up_on_failure(file):
            file.introduce(self._handling, now_ns)
            if self._pauses:
                file.note(PAUSES_RECORD, format_pauses(self._pauses))
            for entry in self._kept.values():
                if entry not in self._waiting:
                    file.repeat(entry, now_ns)
        return file

    def _finish(self, file: RecordingFile) -> Path:
        dropped, unwritten = Counter(self._dropped()), Counter(self._handling.unwritten())
        with self._giving_up_on_failure(file):
            file.note_all(self._handling.records())
            if self.paused:
                file.note(PAUSES_RECORD, format_pauses(self._pauses))
            path = file.finish(dropped - self._dropped_before, unwritten - self._unwritten_before)
        self._dropped_before, self._unwritten_before = dropped, unwritten
        self._pauses = {}
        self._file = None
        self._latest = {**self._latest, **file.latest}
        return path

    @contextlib.contextmanager
    def _giving_up_on_failure(self, file: RecordingFile) -> Iterator[None]:
        try:
            yield
        except RecordingError as error:
            raise self._given_up(file, error) from error.__cause__

    def _given_up(self, file: RecordingFile, error: RecordingError) -> RecordingError:
        """Take back what stands only in memory of a file that failed, and return what to raise."""
        self._file = None
        self._latest = {**self._latest, **file.latest}
        self._waiting.extendleft(reversed(file.give_up()))
        return error if file.worth_keeping else self._left_no_file(error)

    def _left_no_file(self, error: RecordingError) -> RecordingError:
        if not isinstance(error.__cause__, OSError):
            return error
        return RecordingError(
            f"cannot write to {self._folder}: {error.__cause__.strerror}: make room or use another "
            "disk; until then what arrives waits in memory"
        )


def format_pauses(pauses: Mapping[int, int | None]) -> dict[str, str]:
    """The values of the metadata record, from the pauses' begins and ends, in nanoseconds since the
    epoch; the end of one that lasts is not known."""
    return {str(began): "" if ended is None else str(ended) for began, ended in pauses.items()}
