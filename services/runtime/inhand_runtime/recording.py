"""Recordings: MCAP files with the very messages that the wire carries.

A recording grows as ``NAME.mcap.part`` and gets its final name when it is whole, so the name
says whether a file may be trusted. Its channels are Zenoh keys, its payloads MessagePack.
"""

import heapq
import json
import os
import struct
from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import IO, Self, cast

from inhand_schemas.errors import KeyFormatError, UnknownVersionError
from inhand_schemas.json_schema import json_schema
from inhand_schemas.keys import ParsedKey
from inhand_schemas.messages import Message
from inhand_schemas.topics import AnyTopic, topic_of
from mcap.exceptions import McapError
from mcap.reader import SeekingReader
from mcap.records import Channel
from mcap.records import Message as MessageRecord
from mcap.summary import Summary
from mcap.writer import MCAP0_MAGIC, CompressionType, Writer
from zstandard import ZstdError

from inhand_runtime.checksums import CHECKSUMS_RECORD, digest, format_digests
from inhand_runtime.errors import InhandError
from inhand_runtime.part_file import PART_SUFFIX, PartFile

PROFILE = "inhand"
SCHEMA_ENCODING = "jsonschema"
MESSAGE_ENCODING = "msgpack"
APART_ENCODING = "x-undecodable"
"""The message encoding of a channel that holds what could not be read on its key."""
CHUNK_BYTES = 1024 * 1024
UNBOUNDED_CHUNK = 1 << 40
"""The writer's own bound on chunks, which are ended here, after their messages' checksums."""
MOST_CHANNELS = 0xFFFF
LATEST_NS = (1 << 64) - 1
SEQUENCE_MASK = 0xFFFFFFFF
REORDERED_NS = 1_000_000_000
"""Messages that were received this much apart, in nanoseconds, stand in order in a file of ours."""

DAMAGE = (
    McapError,
    ValueError,
    LookupError,
    ArithmeticError,
    MemoryError,
    RuntimeError,
    struct.error,
    ZstdError,
)
"""What the MCAP library raises on damaged bytes."""


class RecordingError(InhandError):
    """A recording that cannot be written or read; the message tells the user the mend."""


@dataclass(frozen=True)
class RecordedMessage:
    """One message of a recording; times are nanoseconds since the epoch.

    ``sequence`` is the message's own, its lowest 32 bits.
    """

    key: str
    topic: AnyTopic
    name: str
    payload: bytes
    received_ns: int
    captured_ns: int
    sequence: int

    def message(self) -> Message:
        """The payload decoded; raises MessageError."""
        return self.topic.decode(self.payload)


class RecordingWriter:
    """Writes one recording, from one thread; every method raises RecordingError.

    After the first failure (a full disk, say) nothing more is written, each call raises that
    failure again, and the ``.part`` keeps what could be written. As a context manager it closes
    the recording, except after an exception: then the ``.part`` stays too.
    """

    def __init__(self, path: Path, *, part_suffix: str = PART_SUFFIX) -> None:
        self.path = path
        self._failure: RecordingError | None = None
        self._channels: dict[tuple[str, bool], int] = {}
        self._schemas: dict[str, int] = {}
        self._digests: list[bytes] = []
        self._chunk_bytes = 0
        self._file = _create(path, part_suffix)
        self._writer = Writer(
            cast(IO[bytes], self._file),
            chunk_size=UNBOUNDED_CHUNK,
            compression=CompressionType.NONE,
            enable_data_crcs=True,
        )
        try:
            with self._reporting():
                self._writer.start(profile=PROFILE)
        except RecordingError:
            self._file.close()
            raise

    @property
    def bytes_written(self) -> int:
        """The size of the file so far, without the chunk that still fills in memory."""
        return self._file.bytes_written

    def write(
        self, key: str, payload: bytes, *, received_ns: int, captured_ns: int, sequence: int
    ) -> None:
        """Add one encoded message; raises KeyFormatError when ``key`` is not Inhand's."""
        self._add(key, payload, received_ns, captured_ns, sequence, apart=False)

    def write_apart(self, key: str, payload: bytes, *, received_ns: int) -> None:
        """Keep what cannot be read on a key, in a channel of its own that readers pass over.

        Raises KeyFormatError when ``key`` is not Inhand's.
        """
        self._add(key, payload, received_ns, received_ns, 0, apart=True)

    def _add(
        self,
        key: str,
        payload: bytes,
        received_ns: int,
        captured_ns: int,
        sequence: int,
        apart: bool,
    ) -> None:
        # The library writes half a message where a number does not fit, and damages the next one.
        if not (0 <= received_ns <= LATEST_NS and 0 <= captured_ns <= LATEST_NS):
            raise RecordingError(f"{key}: a time before 1970, or after 2554, cannot be recorded")
        with self._reporting():
            channel = self._channels.get((key, apart)) or self._register(key, apart)
            stamp = channel, sequence & SEQUENCE_MASK, received_ns, captured_ns
            self._writer.add_message(channel, received_ns, payload, captured_ns, stamp[1])
            self._digests.append(digest(*stamp, payload))
            self._chunk_bytes += len(payload)
            if self._chunk_bytes > CHUNK_BYTES:
                self._end_chunk()

    def _end_chunk(self) -> None:
        """Write the messages' checksums, and then the chunk that waits in memory."""
        if self._digests:
            self._writer.add_metadata(CHECKSUMS_RECORD, format_digests(self._digests))
        self._digests.clear()
        self._chunk_bytes = 0
        self._writer.flush()  # type: ignore[no-untyped-call]

    def add_metadata(self, name: str, values: Mapping[str, str]) -> None:
        """Add one named record about the recording; a later one of that name replaces it."""
        with self._reporting():
            self._writer.add_metadata(name, dict(values))

    def sync(self) -> None:
        """Bring everything so far to the disk, so that even a power cut leaves it."""
        with self._reporting():
            self._end_chunk()
            self._file.sync()

    def close(self) -> Path:
        """Finish the file and give it its final name, which is returned."""
        if self._failure is None and self._file.closed:
            return self.path
        try:
            with self._reporting():
                self._end_chunk()
                self._writer.finish()  # type: ignore[no-untyped-call]
                self._file.publish()
        finally:
            self._file.close()
        return self.path

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        try:
            if kind is None:
                self.close()
            elif self._failure is None and not self._file.closed:
                self.sync()
        finally:
            self._file.close()

    def _register(self, key: str, apart: bool) -> int:
        topic, _ = topic_of(key)
        if len(self._channels) >= MOST_CHANNELS:
            raise RecordingError(f"{self.path} holds {MOST_CHANNELS} keys: begin another recording")
        if apart:
            channel = self._writer.register_channel(key, APART_ENCODING, 0)
            self._channels[key, apart] = channel
            return channel
        name = f"{topic.message_type.__name__}.v1"
        if name not in self._schemas:
            schema = json.dumps(json_schema(topic.message_type)).encode()
            self._schemas[name] = self._writer.register_schema(name, SCHEMA_ENCODING, schema)
        schema_id = self._schemas[name]
        channel = self._writer.register_channel(key, MESSAGE_ENCODING, schema_id)
        self._channels[key, apart] = channel
        return channel

    @contextmanager
    def _reporting(self) -> Iterator[None]:
        if self._failure is not None:
            raise self._failure
        if self._file.closed:
            raise RecordingError(f"{self.path} is closed: open another recording")
        try:
            yield
        except OSError as error:
            self._failure = RecordingError(
                f"cannot write {self._file.part}: {error.strerror}: make room or use another disk; "
                f"`inhand recording recover {self._file.part}` saves what was written"
            )
            raise self._failure from error


def _create(path: Path, part_suffix: str) -> PartFile:
    try:
        if path.exists():
            raise RecordingError(f"{path} exists already: choose another name, or move it away")
        return PartFile(path, part_suffix)
    except FileExistsError:
        part = path.with_name(path.name + part_suffix)
        raise RecordingError(
            f"{part} is left from a recording that was cut off: "
            f"run `inhand recording recover {part}`, then delete it"
        ) from None
    except OSError as error:
        raise RecordingError(
            f"cannot create {path}: {error.strerror}: use a folder that exists and can be written"
        ) from error


def read_recording(
    path: Path, *, streams: Collection[str] | None = None
) -> Iterator[RecordedMessage]:
    """The messages of a whole recording in the order of their reception.

    Where the clock was set back while it was recorded, what stands later in the file comes later;
    in files of other writers the times alone say the order.

    ``streams`` chooses; keys that are not Inhand's are passed over. Raises RecordingError for a
    file that is missing, foreign, cut off or damaged, and UnknownVersionError.
    """
    with _open(path) as reader:
        chosen = _choose(_summary(path, reader).channels.values(), streams)
        for key, message in _records(path, reader, chosen):
            topic, parsed = chosen[key]
            times = message.log_time, message.publish_time
            yield RecordedMessage(key, topic, parsed.name, message.data, *times, message.sequence)


def read_metadata(path: Path) -> dict[str, dict[str, str]]:
    """The named records about a whole recording; raises RecordingError."""
    with _open(path) as reader:
        _summary(path, reader)
        with _explaining_damage(path):
            return {
                record.name: record.metadata
                for record in reader.iter_metadata()
                if record.name != CHECKSUMS_RECORD
            }


def _choose(
    channels: Iterable[Channel], streams: Collection[str] | None
) -> dict[str, tuple[AnyTopic, ParsedKey]]:
    chosen = {}
    for channel in channels:
        if channel.message_encoding != MESSAGE_ENCODING:
            continue
        try:
            topic, parsed = topic_of(channel.topic)
        except KeyFormatError as error:
            if isinstance(error, UnknownVersionError):
                raise
            continue
        if streams is None or topic.stream in streams:
            chosen[channel.topic] = topic, parsed
    return chosen


def _records(
    path: Path, reader: SeekingReader, keys: Collection[str]
) -> Iterator[tuple[str, MessageRecord]]:
    with _explaining_damage(path):
        ours = reader.get_header().profile == PROFILE
    records = (
        (channel.topic, message)
        for _, channel, message in reader.iter_messages(topics=keys, log_time_order=not ours)
        if channel.message_encoding == MESSAGE_ENCODING
    )
    in_order = _in_order_of_reception(records) if ours else records
    while True:
        with _explaining_damage(path):
            record = next(in_order, None)
        if record is None:
            return
        yield record


def _in_order_of_reception(
    records: Iterator[tuple[str, MessageRecord]],
) -> Iterator[tuple[str, MessageRecord]]:
    """Sort what lies within a second; what lies farther back comes after a clock that was set."""
    waiting: list[tuple[int, int, tuple[str, MessageRecord]]] = []
    newest_ns = 0
    for number, record in enumerate(records):
        time_ns = record[1].log_time
        if time_ns < newest_ns - REORDERED_NS:
            yield from (heapq.heappop(waiting)[2] for _ in range(len(waiting)))
            newest_ns = 0
        newest_ns = max(newest_ns, time_ns)
        heapq.heappush(waiting, (time_ns, number, record))
        while waiting[0][0] < newest_ns - REORDERED_NS:
            yield heapq.heappop(waiting)[2]
    yield from (heapq.heappop(waiting)[2] for _ in range(len(waiting)))


@contextmanager
def _open(path: Path) -> Iterator[SeekingReader]:
    try:
        file = path.open("rb")
    except FileNotFoundError:
        raise RecordingError(f"{path} does not exist: check the path") from None
    except OSError as error:
        raise RecordingError(
            f"cannot read {path}: {error.strerror}: give a file that you may read"
        ) from error
    with file:
        _require_whole(path, file)
        yield SeekingReader(file, validate_crcs=True)


def _require_whole(path: Path, file: IO[bytes]) -> None:
    head = file.read(len(MCAP0_MAGIC))
    if not MCAP0_MAGIC.startswith(head):
        raise RecordingError(f"{path} is no recording: give a .mcap file")
    size = file.seek(0, os.SEEK_END)
    file.seek(max(0, size - len(MCAP0_MAGIC)))
    if size < 2 * len(MCAP0_MAGIC) or file.read() != MCAP0_MAGIC:
        raise RecordingError(
            f"{path} was cut off: `inhand recording recover {path}` saves what is left"
        )
    file.seek(0)


def _summary(path: Path, reader: SeekingReader) -> Summary:
    with _explaining_damage(path):
        summary = reader.get_summary()
    if summary is None:
        raise RecordingError(f"{path} has no index: `inhand recording recover {path}` writes one")
    return summary


@contextmanager
def _explaining_damage(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise RecordingError(f"cannot read {path}: {error.strerror}") from error
    except DAMAGE as error:
        raise RecordingError(
            f"{path} is damaged ({error}): `inhand recording recover {path}` saves what is left"
        ) from error
