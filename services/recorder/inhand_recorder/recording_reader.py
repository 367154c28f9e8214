"""Recordings as Python reads them: in a loop, in order of time, and by topic and time."""

from collections import Counter, deque
from collections.abc import Iterable, Iterator
from fnmatch import fnmatchcase
from functools import cached_property
from heapq import heappop, heappush, merge
from pathlib import Path
from types import TracebackType
from typing import Self

import numpy as np
from inhand_runtime.recording import RecordedMessage, RecordingError, read_metadata
from inhand_runtime.recording.chunk_table import Integers
from inhand_runtime.recording.layout import LATEST_NS
from inhand_runtime.recording.message_index import IndexedMessages
from inhand_schemas.errors import MessageError
from inhand_schemas.keys import parse_key
from inhand_schemas.messages import CameraInfo
from inhand_schemas.topics import INFO, RGBD, AnyTopic
from mcap.records import Attachment

from inhand_recorder.attachments import first_attachments, read_attachments
from inhand_recorder.recorded import Recorded, decoded
from inhand_recorder.recorded_content import content_digest
from inhand_recorder.recording_files import RecordingFiles
from inhand_recorder.recording_series import Places, Series


class Recording:
    """An open recording: a context manager, and an iterable of all its messages.

    ``recording["rgbd/front"]`` is the series of a topic, by ``STREAM/NAME`` or by the whole key.
    ``damaged`` counts, by topic, the messages that loops passed over, since a checksum contradicts
    them or they cannot be decoded. ``notes`` are lines on files that are not whole.
    """

    def __init__(self, paths: list[Path], optional: frozenset[Path] = frozenset()) -> None:
        """Open the files; raises RecordingError."""
        self._files = RecordingFiles(paths, optional)
        self.notes = tuple(self._files.notes)
        self.damaged: Counter[str] = Counter()
        self._kinds: dict[str, AnyTopic] = {}
        for one in self._files.summaries:
            self._kinds |= one.topics
        self._names = _names(self._kinds)
        self._series: dict[str, Series] = {}

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close all files; what was read stays, and nothing more can be read."""
        self._files.close()

    @property
    def paths(self) -> tuple[Path, ...]:
        """The files in the order of time."""
        return tuple(one.path for one in self._files.summaries)

    @property
    def start_ns(self) -> int:
        """When the first message was received, in nanoseconds since the epoch."""
        return min((one.start_ns for one in self._files.summaries if one.start_ns), default=0)

    @property
    def end_ns(self) -> int:
        """When the last message was received, in nanoseconds since the epoch."""
        return max(one.end_ns for one in self._files.summaries)

    @property
    def duration_s(self) -> float:
        """Seconds from the first message to the last, pauses included."""
        return (self.end_ns - self.start_ns) / 1e9

    @cached_property
    def topics(self) -> dict[str, int]:
        """Numbers of messages by topic, damaged ones included."""
        return {self._names[key]: self._count(key) for key in sorted(self._kinds)}

    def count(self, keys: Iterable[str]) -> int:
        """Return the number of messages of whole keys, damaged ones included."""
        return sum(self.topics[self._names[key]] for key in keys)

    @property
    def apart(self) -> dict[str, int]:
        """Numbers of messages by whole key that could not be read on it when they were recorded.

        Only ``messages_apart`` yields them.
        """
        found = Counter[str]()
        for one in self._files.summaries:
            found.update(one.apart)
        return dict(found)

    @property
    def keys(self) -> dict[str, AnyTopic]:
        """The whole keys, and of what stream each is."""
        return dict(self._kinds)

    @cached_property
    def infos(self) -> dict[str, CameraInfo]:
        """The first description of each camera by its name, or by its key where the recording is
        of several rigs."""
        return {
            self._names[key].rpartition("/")[2] if self._of_one_rig else key: info
            for key, info in self._infos.items()
        }

    def info_of(self, key: str) -> CameraInfo | None:
        """Return the first description of the camera that a key, as of its frames, names."""
        parsed = parse_key(key)
        return self._infos.get(INFO.key(parsed.site, parsed.name))

    @cached_property
    def _infos(self) -> dict[str, CameraInfo]:
        infos = {}
        for key, kind in self._kinds.items():
            first = next(iter(self[key]), None) if kind is INFO else None
            if first is not None and isinstance(first.message, CameraInfo):
                infos[key] = first.message
        return infos

    def metadata(self) -> dict[Path, dict[str, dict[str, str]]]:
        """Read the named records (losses, steps of the clock, …) of each file; none of those that
        are not whole."""
        return {
            one.path: read_metadata(one.path) if one.whole else {} for one in self._files.summaries
        }

    def attachments(self) -> list[Attachment]:
        """Read what is attached to the files, the same once; of those that are not whole what
        stands at their begin, as meshes do."""
        found: dict[tuple[str, bytes], Attachment] = {}
        for one in self._files.summaries:
            read = read_attachments if one.whole else first_attachments
            for attached in read(one.path):
                found.setdefault((attached.name, attached.data), attached)
        return list(found.values())

    def __len__(self) -> int:
        return sum(self.topics.values())

    def __iter__(self) -> Iterator[Recorded]:
        return self.read()

    def __contains__(self, topic: object) -> bool:
        return isinstance(topic, str) and (topic in self._kinds or topic in self._names.values())

    def __getitem__(self, topic: str) -> Series:
        """Return the series of a topic; raises RecordingError where there is none, or several."""
        key = self._key(topic)
        if key not in self._series:
            self._series[key] = Series(self, key, self._names[key], self._places(key))
        return self._series[key]

    def read(self, *topics: str, start_ns: int = 0, end_ns: int = LATEST_NS) -> Iterator[Recorded]:
        """Yield messages in the order of their reception, of all topics or those that match
        (``pose/*``).

        They were received from ``start_ns`` until before ``end_ns``. Raises RecordingError where no
        topic matches.
        """
        keys = self.matching(topics) if topics else list(self._kinds)
        for message in self.messages(keys, start_ns=start_ns, end_ns=end_ns):
            if (one := self._decoded(message)) is not None:
                yield one

    def messages(
        self, keys: Iterable[str], *, start_ns: int = 0, end_ns: int = LATEST_NS
    ) -> Iterator[RecordedMessage]:
        """Yield messages of whole keys as they were recorded, without decoding them.

        Damaged ones are passed over and counted. Raises RecordingError where files hold different
        messages of one key with one number and the same times.
        """
        repeats = _Repeats()
        latest: dict[str, RecordedMessage] = {}
        for key, file, number in self._merged(list(keys), start_ns, end_ns):
            message = self.whole_at(key, file, number)
            if message is None:
                continue
            stamp = message.sequence, message.captured_ns, message.received_ns
            if not repeats.has(key, self._kinds[key], file, stamp):
                latest[key] = message
                yield message
            elif content_digest(latest[key]) != content_digest(message):
                raise RecordingError(
                    f"{self._files.summaries[file].path.name} and another file hold different "
                    f"messages of {key} at one time: give recordings of one rig each, or leave the "
                    "topic out"
                )

    def messages_apart(
        self, keys: Iterable[str], *, start_ns: int = 0, end_ns: int = LATEST_NS
    ) -> Iterator[RecordedMessage]:
        """Yield what is kept apart of whole keys, in the order of reception; what another file
        repeats once, and damaged ones are passed over and counted."""
        repeats, chosen = _Repeats(), set(keys)
        of_files = (self._apart_in(file, chosen) for file in range(len(self._files.summaries)))
        for file, one in merge(*of_files, key=lambda read: read[1].received_ns):
            stamp = one.sequence, one.captured_ns, one.received_ns
            if start_ns <= one.received_ns < end_ns and not repeats.has(
                one.key, one.topic, file, stamp
            ):
                yield one

    def _apart_in(self, file: int, keys: set[str]) -> Iterator[tuple[int, RecordedMessage]]:
        """Yield what a file keeps apart, beside the file's number."""
        summary = self._files.summaries[file]
        places = sorted(
            (received_ns, key, number)
            for key in summary.apart
            if key in keys
            for number, received_ns in enumerate(
                self._files.apart(summary.path, key).received_ns.tolist()
            )
        )
        for _, key, number in places:
            try:
                yield file, self._files.apart(summary.path, key)[number]
            except RecordingError as error:
                if isinstance(error.__cause__, OSError):
                    raise
                self.damaged[_short(key)] += 1

    def matching(self, patterns: Iterable[str]) -> list[str]:
        """Return the keys whose topic, or whole key, matches one of the patterns (``*``, ``?``).

        Raises RecordingError for a pattern that none matches.
        """
        chosen: dict[str, None] = {}
        for pattern in patterns:
            found = [key for key in self._kinds if matches(key, pattern)]
            if not found and not any(matches(key, pattern) for key in self.apart):
                raise RecordingError(f"there is no topic {pattern!r}; there are: {self._listed()}")
            chosen |= dict.fromkeys(found)
        return list(chosen)

    def whole_at(self, key: str, file: int, number: int) -> RecordedMessage | None:
        """Read a message of a key by the number of its file and its own in that; None, and counted,
        where it is damaged."""
        try:
            return self.read_at(key, file, number)
        except RecordingError as error:
            if isinstance(error.__cause__, OSError):
                raise
            self.damaged[self._names[key]] += 1
            return None

    def read_at(self, key: str, file: int, number: int) -> RecordedMessage:
        """Read a message by the same numbers; raises RecordingError."""
        return self._files.read(self._files.summaries[file].path, key, number)

    def decoded_at(self, key: str, file: int, number: int) -> Recorded | None:
        """Read and decode a message; None, and counted, where it is damaged."""
        message = self.whole_at(key, file, number)
        return None if message is None else self._decoded(message)

    def decode(self, message: RecordedMessage) -> Recorded:
        """Decode a message; raises MessageError."""
        info = self.info_of(message.key) if message.topic is RGBD else None
        return decoded(message, self._names[message.key], info)

    def captured_ns(self, key: str, places: Places) -> Integers:
        """Read the times of capture of messages of a key."""
        times = np.zeros(len(places.numbers), np.int64)
        for file in np.unique(places.files):
            of_file = places.files == file
            captured_ns = self._messages(key, int(file)).stamps.captured_ns
            times[of_file] = captured_ns[places.numbers[of_file]]
        return times

    def _decoded(self, message: RecordedMessage) -> Recorded | None:
        try:
            return self.decode(message)
        except MessageError:
            self.damaged[self._names[message.key]] += 1
            return None

    def _messages(self, key: str, file: int) -> IndexedMessages:
        return self._files.messages(self._files.summaries[file].path, key)

    def _merged(
        self, keys: list[str], start_ns: int, end_ns: int
    ) -> Iterator[tuple[str, int, int]]:
        """Yield the places of messages in the order of reception; a file's index is read when the
        loop comes to the file."""
        waiting = deque(enumerate(self._files.summaries))
        places: dict[int, Iterator[tuple[int, str, int]]] = {}
        heap: list[tuple[int, int, str, int]] = []
        while waiting or heap:
            while waiting and (not heap or waiting[0][1].start_ns <= heap[0][0]):
                file, summary = waiting.popleft()
                if summary.start_ns < end_ns and summary.end_ns >= start_ns:
                    held = [key for key in keys if key in summary.counts]
                    places[file] = self._files.in_order(summary.path, held, start_ns, end_ns)
                    _push(heap, file, places[file])
            if heap:
                _, file, key, number = heappop(heap)
                yield key, file, number
                _push(heap, file, places[file])

    def _places(self, key: str) -> Places:
        """Find all messages of a key; what another file repeats is left out."""
        files = [n for n, one in enumerate(self._files.summaries) if key in one.counts]
        times = [self._messages(key, file).received_ns for file in files]
        counts = [len(one) for one in times]
        found = Places(
            np.repeat(np.array(files, np.int64), counts),
            np.concatenate([np.arange(count) for count in counts]),
            np.concatenate(times),
        )
        if self.overlapping:
            found = found.chosen(np.argsort(found.received_ns, kind="stable"))
        return self._without_repeats(key, found) if self._may_repeat(key) else found

    def _without_repeats(self, key: str, found: Places) -> Places:
        repeats, kind = _Repeats(), self._kinds[key]
        stamps = {
            int(file): self._messages(key, int(file)).stamps for file in np.unique(found.files)
        }
        kept = []
        for place, (file, number, received_ns) in enumerate(found.rows()):
            of_file = stamps[file]
            sequence, captured_ns = of_file.sequences[number], of_file.captured_ns[number]
            stamp = int(sequence), int(captured_ns), received_ns
            if not repeats.has(key, kind, file, stamp):
                kept.append(place)
        return found.chosen(np.array(kept, np.int64))

    def numbers(self, key: str) -> Iterator[tuple[int, int]]:
        """Yield, for each message of a key, the number of its file in ``paths`` and its own."""
        found = self[key].places
        stamps = {
            int(file): self._messages(key, int(file)).stamps for file in np.unique(found.files)
        }
        for file, number, _ in found.rows():
            yield file, int(stamps[file].sequences[number])

    def _count(self, key: str) -> int:
        if self._may_repeat(key):
            return len(self[key])
        return sum(one.counts.get(key, 0) for one in self._files.summaries)

    def _may_repeat(self, key: str) -> bool:
        several = len(self._files.summaries) > 1
        return several and (self.overlapping or self._kinds[key].delivery.kept)

    @cached_property
    def overlapping(self) -> bool:
        """Whether a file begins before another one has ended."""
        latest_ns = -1
        for one in self._files.summaries:
            if one.counts and one.start_ns <= latest_ns:
                return True
            latest_ns = max(latest_ns, one.end_ns)
        return False

    @property
    def _of_one_rig(self) -> bool:
        return len({parse_key(key).site for key in self._kinds}) <= 1

    def _key(self, topic: str) -> str:
        found = [key for key in self._kinds if topic in (key, _short(key))]
        if len(found) == 1:
            return found[0]
        if found:
            raise RecordingError(
                f"{topic!r} is of several rigs: give a whole key, one of {', '.join(found)}"
            )
        raise RecordingError(f"there is no topic {topic!r}; there are: {self._listed()}")

    def _listed(self) -> str:
        return ", ".join(sorted(self._names.values())) or "none"


class _Repeats:
    """Recognises messages that another file holds as well: whole copies, and the last message of a
    kept stream, which each file begins with."""

    def __init__(self) -> None:
        self._latest: dict[str, tuple[int, tuple[int, int, int]]] = {}

    def has(self, key: str, kind: AnyTopic, file: int, stamp: tuple[int, int, int]) -> bool:
        """Whether a message with that number and times of capture and reception is a repeat."""
        before = self._latest.get(key)
        if before is not None and before[0] != file:
            compared = 2 if kind.delivery.kept else 3
            if before[1][:compared] == stamp[:compared]:
                return True
        self._latest[key] = file, stamp
        return False


def _push(
    heap: list[tuple[int, int, str, int]], file: int, places: Iterator[tuple[int, str, int]]
) -> None:
    """Put the next message of a file among those that wait."""
    following = next(places, None)
    if following is not None:
        received_ns, key, number = following
        heappush(heap, (received_ns, file, key, number))


def _short(key: str) -> str:
    """Return ``STREAM/NAME`` of a key."""
    return "/".join(key.split("/")[-2:])


def _names(keys: Iterable[str]) -> dict[str, str]:
    """Name each key by its stream and name where that is of one rig, and else by itself."""
    counts = Counter(map(_short, keys))
    return {key: _short(key) if counts[_short(key)] == 1 else key for key in keys}


def matches(key: str, pattern: str) -> bool:
    """Whether ``STREAM/NAME`` of a key, or the whole key, matches a pattern."""
    return fnmatchcase(_short(key), pattern) or fnmatchcase(key, pattern)
