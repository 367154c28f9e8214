"""The files of a recording: which they are, and a bounded number of them open at a time."""

import logging
from collections import OrderedDict
from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inhand_runtime.recording import RecordedMessage, RecordingError
from inhand_runtime.recording.chunk_table import Integers
from inhand_runtime.recording.message_index import IndexedMessages, RecordingIndex, open_index
from inhand_runtime.recording.part_file import PART_SUFFIX
from inhand_runtime.recording.reading import in_order_of_reception
from inhand_schemas.topics import AnyTopic

log = logging.getLogger(__name__)

_MOST_OPEN = 16
"""Number of files, each with its index in memory, that are open at a time."""


@dataclass(frozen=True)
class FileSummary:
    """A file with its topics and numbers of messages by key, the times, in nanoseconds, at which
    its first and last message were received (0 where it has none), whether it is whole, and the
    numbers by key of messages that it keeps apart as undecodable."""

    path: Path
    topics: dict[str, AnyTopic]
    counts: dict[str, int]
    start_ns: int
    end_ns: int
    whole: bool
    apart: dict[str, int]


class RecordingFiles:
    """Reads messages of several files, of which few are open."""

    def __init__(self, paths: Sequence[Path], optional: frozenset[Path] = frozenset()) -> None:
        """Look into all files; raises RecordingError, but for ``optional`` ones, of which a note
        says it."""
        self.notes: list[str] = []
        self._open: OrderedDict[Path, _OpenFile] = OrderedDict()
        summaries = [one for path in paths if (one := self._summary(path, path in optional))]
        if not summaries:
            self.close()
            raise RecordingError(f"there is nothing to read: {'; '.join(self.notes)}")
        self.summaries = tuple(sorted(summaries, key=lambda one: (one.start_ns, one.path.name)))
        for note in self.notes:
            log.warning("%s", note)

    def messages(self, path: Path, key: str) -> IndexedMessages:
        """Return the messages of a key in a file, of which one is read when it is asked for.

        Use them at once: the file may be closed as soon as others are read.
        """
        return self._opened(path).messages(key)

    def in_order(
        self, path: Path, keys: Iterable[str], start_ns: int, end_ns: int
    ) -> Iterator[tuple[int, str, int]]:
        """Yield time of reception, key and number of the messages that were received from
        ``start_ns`` until before ``end_ns``, in the order of their reception."""
        opened = self._opened(path)
        of_keys = [(key, opened.messages(key).received_ns) for key in keys]
        times = _joined(times for _, times in of_keys)
        places = _joined(opened.messages(key).places for key, _ in of_keys)
        owners = np.repeat(np.arange(len(of_keys)), [len(one) for _, one in of_keys])
        numbers = _joined(np.arange(len(times)) for _, times in of_keys)
        order = np.argsort(places if opened.index.ours else times, kind="stable")
        timed = ((int(times[one]), int(one)) for one in order)
        for one in in_order_of_reception(timed):
            if start_ns <= times[one] < end_ns:
                yield int(times[one]), of_keys[owners[one]][0], int(numbers[one])

    def apart(self, path: Path, key: str) -> IndexedMessages:
        """Return what a file keeps apart of a key, to be used in the same way."""
        return self._opened(path).index.apart_of(key)

    def read(self, path: Path, key: str, number: int) -> RecordedMessage:
        """Read one message; raises RecordingError."""
        return self.messages(path, key)[number]

    def close(self) -> None:
        """Close all files."""
        while self._open:
            self._open.popitem()[1].close()

    def _opened(self, path: Path) -> "_OpenFile":
        if path in self._open:
            self._open.move_to_end(path)
            return self._open[path]
        opened = _OpenFile(path)
        self._open[path] = opened
        if len(self._open) > _MOST_OPEN:
            self._open.popitem(last=False)[1].close()
        return opened

    def _summary(self, path: Path, optional: bool) -> FileSummary | None:
        try:
            opened = self._opened(path)
            topics = opened.index.keys()
            times = [opened.messages(key).received_ns for key in topics]
        except RecordingError as error:
            if not optional:
                self.close()
                raise
            self.notes.append(f"left out: {error}")
            return None
        if opened.index.note is not None:
            self.notes.append(f"{opened.index.note}; what is whole in it is read")
        start_ns = min((int(one.min()) for one in times if len(one)), default=0)
        end_ns = max((int(one.max()) for one in times if len(one)), default=0)
        counts = {key: opened.index.count(key) for key in topics}
        whole = opened.index.note is None
        return FileSummary(path, topics, counts, start_ns, end_ns, whole, opened.index.apart)


class _OpenFile:
    """An open file, and the places of its messages by key."""

    def __init__(self, path: Path) -> None:
        self._stack = ExitStack()
        self.index: RecordingIndex = self._stack.enter_context(open_index(path))
        self._messages: dict[str, IndexedMessages] = {}

    def messages(self, key: str) -> IndexedMessages:
        if key not in self._messages:
            self._messages[key] = self.index.messages_of(key)
        return self._messages[key]

    def close(self) -> None:
        self._stack.close()


def _joined(parts: Iterable[Integers]) -> Integers:
    return np.concatenate([np.zeros(0, np.int64), *parts])


def find_files(paths: Path | str | Iterable[Path | str]) -> tuple[list[Path], frozenset[Path]]:
    """Find the files at one path or several, of a folder all recordings in it; and those of them
    that may hold nothing, as they are unfinished files in a folder.

    Raises RecordingError where there is none.
    """
    given = [Path(paths)] if isinstance(paths, str | Path) else [Path(one) for one in paths]
    if not given:
        raise RecordingError("no recording is named: give a file or a folder")
    found: dict[Path, bool] = {}
    for path in given:
        if not path.is_dir():
            found[path] = False
            continue
        inside = sorted([*path.glob("*.mcap"), *path.glob(f"*.mcap{PART_SUFFIX}")])
        if not inside:
            raise RecordingError(f"{path} holds no recording: choose another folder")
        for one in inside:
            found.setdefault(one, one.name.endswith(PART_SUFFIX))
    return list(found), frozenset(path for path, optional in found.items() if optional)
