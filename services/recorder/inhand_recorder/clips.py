"""Clips: files of the last seconds before a word or an event, and of the seconds after it."""

import logging
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from inhand_runtime.recording import RecordingError

from inhand_recorder.file_names import free_path
from inhand_recorder.recording_file import PLAIN_FILES, Entry, FileHandling, RecordingFile
from inhand_recorder.ring import Ring, RingBounds

log = logging.getLogger(__name__)

CLIPS_FOLDER = "clips"
"""The folder of clips in that of the recordings; no quota deletes what is in it."""
CLIP_RECORD = "clip"
"""The name of the metadata record that says what a clip is of: by the time of each trigger, in
nanoseconds since the epoch, what it was."""
STEP_BYTES = 4 << 20
"""Bytes of a clip that are written between two messages of the recording, so that these do not
wait."""
SYNC_BYTES = 16 << 20
"""Bytes after which a clip is brought to the disk."""
RETRY_S = 2.0
"""Seconds after a failure until a clip is written anew, of what the ring still holds."""


@dataclass(frozen=True)
class ClipsFolder:
    """Where clips go, of which rig they are, how many seconds after a trigger they end, and what
    is the same for all files."""

    path: Path
    rig: str
    after_s: float
    files: FileHandling = PLAIN_FILES


@dataclass
class _Clip:
    """A clip under way: until what came at ``ends_at``, and ``next`` is the number in the ring of
    what is written next. Until the first entry is written, and after a failure, it has no file."""

    path: Path
    next: int
    ends_at: float
    triggers: dict[int, str]
    file: RecordingFile | None = None
    unsynced: int = 0
    retry_at: float = 0.0


class Clips:
    """Holds the last seconds, and writes a clip of them when something happens.

    Times are of a clock that nobody sets, in seconds. What happens while a clip is written makes
    that one longer. A clip that fails is begun anew, of what is held by then; ``report`` gets what
    failed, and None when that is over.
    """

    def __init__(
        self, folder: ClipsFolder, bounds: RingBounds, report: Callable[[str | None], None]
    ) -> None:
        self.ring = Ring(bounds)
        self._folder = folder
        self._report = report
        self._kept_before: dict[str, Entry] = {}
        self._clip: _Clip | None = None

    @property
    def under_way(self) -> str | None:
        """The name of the clip that is being written."""
        return None if self._clip is None else self._clip.path.name

    def take(self, arrived: float, entry: Entry) -> None:
        """Hold an entry; what has to go for it is written first, where it belongs to a clip."""
        while self.ring.must_shrink(arrived, coming=len(entry.payload)):
            self._drop_oldest(arrived)
        self.ring.add(arrived, entry)

    def trigger(self, why: str, at_ns: int, now: float) -> str:
        """Write a clip of what is held and of what comes, or make the one under way longer; returns
        its name. ``at_ns``, in nanoseconds since the epoch, is ``now`` by the calendar."""
        ends_at = now + self._folder.after_s
        if self._clip is None:
            while self.ring.must_shrink(now):
                self._drop_oldest(now)
            path = free_path(self._folder.path, self._folder.rig, at_ns)
            self._clip = _Clip(path, self.ring.first, ends_at, {at_ns: why})
        else:
            self._clip.ends_at = max(self._clip.ends_at, ends_at)
            self._clip.triggers[at_ns] = why
        return self._clip.path.name

    def step(self, now: float, *, all_came: bool, most_bytes: int = STEP_BYTES) -> None:
        """Write some of the clip, and make it whole at its end; ``all_came`` says that nothing that
        came until now waits to be taken."""
        if (clip := self._clip) is None or now < clip.retry_at:
            return
        written = 0
        while written < most_bytes and clip.next < self.ring.end:
            arrived, entry = self.ring[clip.next]
            if arrived > clip.ends_at:
                self._finish(clip, now)
                return
            if not self._write(clip, entry, now):
                return
            clip.next += 1
            written += len(entry.payload)
        if all_came and now > clip.ends_at and clip.next == self.ring.end:
            self._finish(clip, now)

    def close(self, now: float) -> None:
        """End the clip under way with what is held."""
        if (clip := self._clip) is None:
            return
        clip.ends_at, clip.retry_at = min(clip.ends_at, now), 0.0
        self.step(now + RETRY_S, all_came=True, most_bytes=sys.maxsize)
        if self._clip is not None:
            self._report(f"{clip.path.name} could not be written any more")

    def _drop_oldest(self, now: float) -> None:
        clip = self._clip
        if clip is not None and clip.next == self.ring.first:
            arrived, entry = self.ring[clip.next]
            if arrived > clip.ends_at:
                self._finish(clip, now)
            elif now >= clip.retry_at:
                self._write(clip, entry, now)
        dropped = self.ring.drop_oldest()
        if clip is not None:
            clip.next = max(clip.next, self.ring.first)
        if dropped.kept:
            self._kept_before[dropped.key] = dropped

    def _write(self, clip: _Clip, entry: Entry, now: float) -> bool:
        """Write one entry of a clip, whose file is made where there is none; returns whether that
        was possible."""
        try:
            if clip.file is None:
                clip.file = self._begin(clip, entry.received_ns)
            clip.file.put(entry)
            clip.unsynced += len(entry.payload)
            if clip.unsynced > SYNC_BYTES:
                clip.file.sync()
                clip.unsynced = 0
        except RecordingError as error:
            self._fail(clip, error, now)
            return False
        return True

    def _begin(self, clip: _Clip, received_ns: int) -> RecordingFile:
        """Begin the file, with the kept values of before what is held; raises RecordingError."""
        try:
            clip.path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise RecordingError(f"cannot create {clip.path.parent}: {error.strerror}") from error
        file = RecordingFile(clip.path, 0.0, self._folder.files.make_room)
        try:
            file.introduce(self._folder.files, received_ns)
            file.note_all(self._records(clip))
            for entry in self._kept_before.values():
                file.repeat(entry, received_ns)
        except RecordingError:
            file.discard()
            raise
        return file

    def _finish(self, clip: _Clip, now: float) -> None:
        if clip.file is not None:
            try:
                clip.file.note_all(self._records(clip))
                path = clip.file.finish({})
            except RecordingError as error:
                self._fail(clip, error, now)
                return
            log.info("%s is whole: %s", path, ", ".join(dict.fromkeys(clip.triggers.values())))
            self._report(None)
        self._clip = None

    def _records(self, clip: _Clip) -> Mapping[str, Mapping[str, str]]:
        triggers = {str(at_ns): why for at_ns, why in clip.triggers.items()}
        return {**self._folder.files.records(), CLIP_RECORD: triggers}

    def _fail(self, clip: _Clip, error: RecordingError, now: float) -> None:
        """Remove what there is of the file, and begin anew in a while."""
        if clip.file is not None:
            clip.file.discard()
        clip.file, clip.unsynced = None, 0
        clip.next, clip.retry_at = self.ring.first, now + RETRY_S
        self._report(f"clip: {error}")
