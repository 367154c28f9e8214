"""Writes MCAP to a file, large payloads without a copy.

``mcap``'s own writer copies each payload three times in memory and takes the checksums with zlib.
Here a chunk is a list of what goes to the file, which the system gathers; its checksum is taken by
zlib-ng, with the processor's instructions for it, and that of the whole file follows from those of
the parts. All but messages and chunks is encoded by ``mcap``.
"""

import struct
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import (
    Attachment,
    AttachmentIndex,
    Channel,
    ChunkIndex,
    DataEnd,
    Footer,
    Header,
    McapRecord,
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
    SummaryOffset,
)
from mcap.writer import MCAP0_MAGIC
from zlib_ng.zlib_ng import crc32, crc32_combine

from inhand_runtime.recording.layout import HEADER, MESSAGE_HEAD
from inhand_runtime.recording.part_file import PartFile

LIBRARY = "inhand"
JOINED_BYTES = 4096
"""Payloads below this are copied behind their heads: that costs less than a part of their own."""
_CHUNK = struct.Struct("<BQQQQIIQ")
"""A chunk up to its contents: opcode, length, first and last time, size, checksum, length of the
compression's name (none), and size again."""
_MESSAGE_INDEX = struct.Struct("<BQHI")
_SUMMARY_END = struct.Struct("<BQQQ")
"""A footer up to its checksum, which covers it."""
_MESSAGE = int(Opcode.MESSAGE)


@dataclass
class _Chunk:
    """Messages that wait for the end of their chunk.

    ``parts`` are its contents, of ``size`` bytes with the checksum ``crc``; ``places`` are, by
    channel, the time of reception and the place of each message, one behind the other.
    """

    parts: list[bytes] = field(default_factory=list)
    size: int = 0
    crc: int = 0
    places: dict[int, list[int]] = field(default_factory=dict)

    def add(self, *parts: bytes) -> None:
        """Add bytes to the contents."""
        for part in parts:
            self.crc = crc32(part, self.crc)
            self.size += len(part)
        self.parts += parts


@dataclass
class _Index:
    """What the end of a file says of what stands before."""

    schemas: list[Schema] = field(default_factory=list)
    channels: list[Channel] = field(default_factory=list)
    chunks: list[ChunkIndex] = field(default_factory=list)
    attachments: list[AttachmentIndex] = field(default_factory=list)
    metadata: list[MetadataIndex] = field(default_factory=list)


class McapWriter:
    """Writes MCAP records to a new file, from one thread; every method may raise OSError.

    Schemas, channels and messages wait in memory until their chunk is ended; all else goes to the
    file at once. What raised anything has to be given up.
    """

    def __init__(self, file: PartFile, profile: str) -> None:
        self._file = file
        self._crc = 0
        self._chunk = _Chunk()
        self._index = _Index()
        self._counts: dict[int, int] = {}
        self._write(MCAP0_MAGIC, _encoded(Header(profile, LIBRARY)))

    @property
    def chunk_bytes(self) -> int:
        """Bytes that wait for the end of their chunk."""
        return self._chunk.size

    def add_schema(self, name: str, encoding: str, data: bytes) -> int:
        """Add a schema and return its number."""
        schema = Schema(len(self._index.schemas) + 1, data, encoding, name)
        self._index.schemas.append(schema)
        self._chunk.add(_encoded(schema))
        return schema.id

    def add_channel(self, topic: str, encoding: str, schema: int) -> int:
        """Add a channel of a schema, 0 for none, and return its number."""
        channel = Channel(len(self._index.channels) + 1, topic, encoding, {}, schema)
        self._index.channels.append(channel)
        self._chunk.add(_encoded(channel))
        return channel.id

    def add_message(
        self, channel: int, sequence: int, log_time: int, publish_time: int, payload: bytes
    ) -> None:
        """Add a message, with times in nanoseconds; the payload must not change until the end of
        the chunk. Raises struct.error where a number does not fit, and adds nothing."""
        length = MESSAGE_HEAD.size - HEADER.size + len(payload)
        head = MESSAGE_HEAD.pack(_MESSAGE, length, channel, sequence, log_time, publish_time)
        chunk = self._chunk
        chunk.places.setdefault(channel, []).extend((log_time, chunk.size))
        if len(payload) < JOINED_BYTES:
            chunk.add(head + payload)
        else:
            chunk.add(head, payload)

    def end_chunk(self) -> None:
        """Write the chunk that waits, if it has any message, and where its messages stand."""
        chunk = self._chunk
        if not chunk.places:
            return
        times = [time_ns for places in chunk.places.values() for time_ns in places[::2]]
        first, last, size = min(times), max(times), chunk.size
        length = _CHUNK.size - HEADER.size + size
        head = _CHUNK.pack(Opcode.CHUNK, length, first, last, size, chunk.crc, 0, size)
        indexes = {one: _message_index(one, places) for one, places in chunk.places.items()}
        self._note(first, last, indexes)
        self._crc = crc32_combine(crc32(head, self._crc), chunk.crc, size)
        for index in indexes.values():
            self._crc = crc32(index, self._crc)
        self._file.write(head, *chunk.parts, *indexes.values())
        self._chunk = _Chunk()

    def _note(self, first: int, last: int, indexes: Mapping[int, bytes]) -> None:
        """Take the chunk that is written next into the index, with its first and last time, and the
        records behind it that say where each channel's messages are."""
        start, chunk = self._file.bytes_written, self._chunk
        end = start + _CHUNK.size + chunk.size
        offsets, place = {}, end
        for channel, index in indexes.items():
            offsets[channel] = place
            place += len(index)
        self._index.chunks.append(
            ChunkIndex(
                chunk_start_offset=start,
                chunk_length=end - start,
                message_start_time=first,
                message_end_time=last,
                message_index_offsets=offsets,
                message_index_length=place - end,
                compression="",
                compressed_size=chunk.size,
                uncompressed_size=chunk.size,
            )
        )
        for channel, places in chunk.places.items():
            self._counts[channel] = self._counts.get(channel, 0) + len(places) // 2

    def add_metadata(self, name: str, values: dict[str, str]) -> None:
        """Write a named record."""
        start, record = self._file.bytes_written, _encoded(Metadata(name, values))
        self._index.metadata.append(MetadataIndex(start, len(record), name))
        self._write(record)

    def add_attachment(self, log_time: int, name: str, media_type: str, data: bytes) -> None:
        """Write an attached file."""
        start = self._file.bytes_written
        record = _encoded(Attachment(0, log_time, name, media_type, data))
        self._index.attachments.append(
            AttachmentIndex(start, len(record), log_time, 0, len(data), name, media_type)
        )
        self._write(record)

    def finish(self) -> None:
        """Write the chunk that waits, the checksum of all before, and the index."""
        self.end_chunk()
        self._write(_encoded(DataEnd(self._crc)))
        start = self._file.bytes_written
        groups, offsets, end = [], [], start
        for opcode, records in self._groups():
            groups.append(b"".join(map(_encoded, records)))
            offsets.append(_encoded(SummaryOffset(opcode, end, len(groups[-1]))))
            end += len(groups[-1])
        summary = b"".join(groups + offsets)
        covered = _SUMMARY_END.pack(Opcode.FOOTER, _SUMMARY_END.size + 4 - HEADER.size, start, end)
        footer = _encoded(Footer(start, end, crc32(covered, crc32(summary))))
        self._file.write(summary, footer, MCAP0_MAGIC)

    def _groups(self) -> Iterator[tuple[int, Sequence[McapRecord]]]:
        """Yield the records of the index, those of one kind together, with their opcode."""
        index = self._index
        groups: tuple[tuple[int, Sequence[McapRecord]], ...] = (
            (Opcode.SCHEMA, index.schemas),
            (Opcode.CHANNEL, index.channels),
            (Opcode.STATISTICS, [self._statistics()]),
            (Opcode.CHUNK_INDEX, index.chunks),
            (Opcode.ATTACHMENT_INDEX, index.attachments),
            (Opcode.METADATA_INDEX, index.metadata),
        )
        yield from (group for group in groups if group[1])

    def _statistics(self) -> Statistics:
        index = self._index
        return Statistics(
            attachment_count=len(index.attachments),
            channel_count=len(index.channels),
            channel_message_counts=self._counts,
            chunk_count=len(index.chunks),
            message_count=sum(self._counts.values()),
            message_end_time=max((one.message_end_time for one in index.chunks), default=0),
            message_start_time=min((one.message_start_time for one in index.chunks), default=0),
            metadata_count=len(index.metadata),
            schema_count=len(index.schemas),
        )

    def _write(self, *parts: bytes) -> None:
        for part in parts:
            self._crc = crc32(part, self._crc)
        self._file.write(*parts)


def _encoded(record: McapRecord) -> bytes:
    builder = RecordBuilder()
    record.write(builder)
    return bytes(builder.end())  # type: ignore[no-untyped-call]


def _message_index(channel: int, entries: Sequence[int]) -> bytes:
    """Return the record that says when a channel's messages came, and where in the chunk each
    is."""
    size = 8 * len(entries)
    length = _MESSAGE_INDEX.size - HEADER.size + size
    head = _MESSAGE_INDEX.pack(Opcode.MESSAGE_INDEX, length, channel, size)
    return head + struct.pack(f"<{len(entries)}Q", *entries)
