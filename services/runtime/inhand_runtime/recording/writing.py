"""Writing recordings, so that a crash or a full disk costs as little as can be."""

import json
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import Self

from inhand_schemas.json_schema import json_schema
from inhand_schemas.topics import topic_of

from inhand_runtime.recording.checksums import CHECKSUMS_RECORD, digest, format_checksums
from inhand_runtime.recording.layout import (
    APART_ENCODING,
    CHUNK_BYTES,
    LATEST_NS,
    MESSAGE_ENCODING,
    MOST_CHANNELS,
    PROFILE,
    SCHEMA_ENCODING,
    SEQUENCE_MASK,
    RecordingError,
)
from inhand_runtime.recording.mcap_writer import McapWriter
from inhand_runtime.recording.part_file import PART_SUFFIX, PartFile, no_room


class RecordingWriter:
    """Writes one recording, from one thread; every method raises RecordingError.

    After the first failure (a full disk, say) nothing more is written, each call raises that
    failure again, and the ``.part`` keeps what could be written. As a context manager it closes
    the recording, except after an exception: then the ``.part`` stays too. A full disk is a failure
    only where ``make_room`` returns False.
    """

    def __init__(
        self,
        path: Path,
        *,
        part_suffix: str = PART_SUFFIX,
        make_room: Callable[[], bool] = no_room,
    ) -> None:
        self.path = path
        self._failure: RecordingError | None = None
        self._channels: dict[tuple[str, bool], int] = {}
        self._schemas: dict[str, int] = {}
        self._digests: list[bytes] = []
        self._in_chunk: dict[int, tuple[str, str]] = {}
        self._file = _create(path, part_suffix, make_room)
        try:
            with self._reporting():
                self._writer = McapWriter(self._file, PROFILE)
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
        if not (0 <= received_ns <= LATEST_NS and 0 <= captured_ns <= LATEST_NS):
            raise RecordingError(f"{key}: a time before 1970, or after 2554, cannot be recorded")
        self._require_open()
        channel = self._channels.get((key, apart)) or self._register(key, apart)
        stamp = channel, sequence & SEQUENCE_MASK, received_ns, captured_ns
        self._writer.add_message(*stamp, payload)
        self._digests.append(digest(*stamp, payload))
        self._in_chunk[channel] = key, APART_ENCODING if apart else MESSAGE_ENCODING
        if self._writer.chunk_bytes > CHUNK_BYTES:
            with self._reporting():
                self._end_chunk()

    def _end_chunk(self) -> None:
        """Write the messages' checksums, and then the chunk that waits in memory."""
        if self._digests:
            self._writer.add_metadata(
                CHECKSUMS_RECORD, format_checksums(self._digests, self._in_chunk)
            )
        self._digests.clear()
        self._in_chunk.clear()
        self._writer.end_chunk()

    def add_metadata(self, name: str, values: Mapping[str, str]) -> None:
        """Add one named record about the recording; a later one of that name replaces it."""
        with self._reporting():
            self._writer.add_metadata(name, dict(values))

    def add_attachment(self, name: str, media_type: str, data: bytes, *, received_ns: int) -> None:
        """Add a file that belongs to the recording."""
        with self._reporting():
            self._writer.add_attachment(received_ns, name, media_type, data)

    def hand_over(self) -> None:
        """Write everything so far, so that the end of this process leaves it, if no power cut."""
        with self._reporting():
            self._end_chunk()

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
                self._writer.finish()
                self._file.publish()
        finally:
            self._file.close()
        return self.path

    def abandon(self) -> None:
        """Write no more, and leave the ``.part`` as it is."""
        self._file.close()

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
            channel = self._writer.add_channel(key, APART_ENCODING, 0)
            self._channels[key, apart] = channel
            return channel
        name = f"{topic.message_type.__name__}.v1"
        if name not in self._schemas:
            schema = json.dumps(json_schema(topic.message_type)).encode()
            self._schemas[name] = self._writer.add_schema(name, SCHEMA_ENCODING, schema)
        schema_id = self._schemas[name]
        channel = self._writer.add_channel(key, MESSAGE_ENCODING, schema_id)
        self._channels[key, apart] = channel
        return channel

    def _require_open(self) -> None:
        if self._failure is not None:
            raise self._failure
        if self._file.closed:
            raise RecordingError(f"{self.path} is closed: open another recording")

    @contextmanager
    def _reporting(self) -> Iterator[None]:
        self._require_open()
        try:
            yield
        except OSError as error:
            self._failure = RecordingError(
                f"cannot write {self._file.part}: {error.strerror}: make room or use another disk; "
                f"`inhand recording recover {self._file.part}` saves what was written"
            )
            raise self._failure from error


def _create(path: Path, part_suffix: str, make_room: Callable[[], bool]) -> PartFile:
    try:
        if path.exists():
            raise RecordingError(f"{path} exists already: choose another name, or move it away")
        return PartFile(path, part_suffix, make_room)
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
