"""Walks an MCAP file that may be whole, cut off or damaged, and finds all that is left.

What a checksum contradicts is not handed out. Where the structure is lost, the walk goes on at
the next record that proves itself.
"""

import mmap
import os
import re
import struct
import zlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import BinaryIO, Literal, TypeAlias

from inhand_runtime.checksums import CHECKSUMS_RECORD, digest, parse_digests
from inhand_runtime.recording import DAMAGE, RecordingError
from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import (
    Attachment,
    AttachmentIndex,
    Channel,
    Chunk,
    ChunkIndex,
    DataEnd,
    Footer,
    Header,
    McapRecord,
    Message,
    MessageIndex,
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
    SummaryOffset,
)
from mcap.stream_reader import get_chunk_data_stream
from mcap.writer import MCAP0_MAGIC as MAGIC

Bytes: TypeAlias = bytes | mmap.mmap
State: TypeAlias = Literal["whole", "cut", "damaged"]

HEADER_BYTES = 9
"""Of every record: the opcode and the length."""
FOOTER_BYTES = HEADER_BYTES + 20
MESSAGE_BYTES = 22
"""Of a message record without its payload."""

_READERS: dict[int, Callable[[ReadDataStream], McapRecord]] = {
    Opcode.HEADER: Header.read,
    Opcode.FOOTER: Footer.read,
    Opcode.SCHEMA: Schema.read,
    Opcode.CHANNEL: Channel.read,
    Opcode.CHUNK: Chunk.read,
    Opcode.MESSAGE_INDEX: MessageIndex.read,
    Opcode.CHUNK_INDEX: ChunkIndex.read,
    Opcode.ATTACHMENT: Attachment.read,
    Opcode.ATTACHMENT_INDEX: AttachmentIndex.read,
    Opcode.STATISTICS: Statistics.read,
    Opcode.METADATA: Metadata.read,
    Opcode.METADATA_INDEX: MetadataIndex.read,
    Opcode.SUMMARY_OFFSET: SummaryOffset.read,
    Opcode.DATA_END: DataEnd.read,
}
_IN_CHUNKS = (Schema, Channel, Message)

# The start of a schema, channel or message within a chunk.
_INNER_ANCHOR = re.compile(rb"(?=[\x03\x04\x05][\s\S]{5}\x00\x00\x00)")

# The start of a chunk, metadata, end of data or footer: opcode, then a length below 2 ** 40.
_ANCHOR = re.compile(rb"(?=[\x06\x0c\x0f\x02][\s\S]{5}\x00\x00\x00)")


@dataclass(frozen=True)
class Stretch:
    """A part of a file, and what could be read of it.

    A ``whole`` stretch is one record, or a chunk's records when their checksum holds. Of a ``cut``
    or ``damaged`` chunk ``records`` are the messages whose own checksum holds, and what it defines
    (schemas and channels); ``doubtful`` are messages that none covers. What a checksum contradicts
    is among ``unread_bytes``.
    """

    offset: int
    length: int
    state: State
    records: tuple[McapRecord, ...] = ()
    unread_bytes: int = 0
    doubtful: tuple[Message, ...] = ()


@contextmanager
def opened(path: Path) -> Iterator[Bytes]:
    """The bytes of a recording in any state; raises RecordingError when it is none.

    Zeros at the end, where a power cut left room without data, are not handed out.
    """
    try:
        with path.open("rb") as file:
            size = _size_without_zeros(file)
            if size == 0:
                yield b""
                return
            with mmap.mmap(file.fileno(), size, access=mmap.ACCESS_READ) as data:
                _require_recording(path, data)
                yield data
    except FileNotFoundError:
        raise RecordingError(f"{path} does not exist: check the path") from None
    except OSError as error:
        raise RecordingError(
            f"cannot read {path}: {error.strerror}: give a file that you may read"
        ) from error


def _size_without_zeros(file: BinaryIO) -> int:
    end = file.seek(0, os.SEEK_END)
    while end > 0:
        start = max(0, end - 2**20)
        file.seek(start)
        block = file.read(end - start).rstrip(b"\0")
        if block:
            return start + len(block)
        end = start
    return 0


def _require_recording(path: Path, data: Bytes) -> None:
    # One damaged byte in the first eight must not make a recording unreadable.
    head = data[: len(MAGIC)]
    if sum(byte != expected for byte, expected in zip(head, MAGIC, strict=False)) > 1:
        raise RecordingError(f"{path} is no recording: give a .mcap or .mcap.part file")


def is_complete(data: Bytes) -> bool:
    """Whether the file was finished: it begins as it must, and ends with a sound index."""
    return data[: len(MAGIC)] == MAGIC and summary_start(data) is not None


def summary_start(data: Bytes) -> int | None:
    """Where the index begins, when the footer is there and the index fits its checksum, if any."""
    end = len(data) - len(MAGIC)
    if end < len(MAGIC) + FOOTER_BYTES or data[end:] != MAGIC:
        return None
    footer = _record_at(data, end - FOOTER_BYTES)
    if not isinstance(footer, Footer):
        return None
    start = footer.summary_start
    if start == 0 or (
        footer.summary_crc and zlib.crc32(data[start : end - 4]) != footer.summary_crc
    ):
        return None
    return start


def has_checksums(data: Bytes) -> bool:
    """Whether a finished file says what its index must add up to; they are optional in MCAP."""
    footer = _record_at(data, len(data) - len(MAGIC) - FOOTER_BYTES)
    return isinstance(footer, Footer) and footer.summary_crc != 0


def channels(data: Bytes) -> dict[int, Channel]:
    """The channels by their number, from wherever the file still tells them."""
    found: dict[int, Channel] = {}
    doubtful: dict[int, Channel] = {}
    for start in (summary_start(data), len(MAGIC)):
        for stretch in scan(data, start) if start is not None else ():
            for record in stretch.records:
                if isinstance(record, Channel):
                    place = doubtful if stretch.state == "damaged" else found
                    place.setdefault(record.id, record)
        if found:  # an index need not repeat the channels: then the data says them
            break
    return doubtful | found


def scan(data: Bytes, offset: int = len(MAGIC)) -> Iterator[Stretch]:
    """All stretches from ``offset`` on, without a hole between them."""
    end = len(data) - len(MAGIC) if data[-len(MAGIC) :] == MAGIC else len(data)
    digests: frozenset[bytes] = frozenset()
    while offset < end:
        stretch = _stretch_at(data, offset, digests)
        for record in stretch.records:
            if isinstance(record, Metadata) and record.name == CHECKSUMS_RECORD:
                digests = parse_digests(record.metadata)
        yield stretch
        offset += stretch.length


def _stretch_at(data: Bytes, offset: int, digests: frozenset[bytes]) -> Stretch:
    record = _record_at(data, offset)
    if isinstance(record, Chunk):
        return _chunk(record, offset, _length_at(data, offset), digests)
    if record is not None:
        return Stretch(offset, _length_at(data, offset), "whole", (record,))
    anchor = _next_anchor(data, offset + 1)
    if anchor is not None:
        return Stretch(offset, anchor - offset, "damaged", (), anchor - offset)
    return _cut(data, offset, digests)


def _chunk(chunk: Chunk, offset: int, length: int, digests: frozenset[bytes]) -> Stretch:
    records = _checked_records(chunk)
    if records is not None:
        return Stretch(offset, length, "whole", records)
    if chunk.compression:
        return Stretch(offset, length, "damaged", (), length)
    times = chunk.message_start_time, chunk.message_end_time
    remains = _remains(chunk.data, digests, times)
    unread = length if not remains.messages else remains.unread_bytes
    return Stretch(offset, length, "damaged", remains.records, unread, remains.doubtful)


def _cut(data: Bytes, offset: int, digests: frozenset[bytes]) -> Stretch:
    rest = data[offset:]
    chunk_head = struct.Struct("<BQQQQIIQ")
    if len(rest) >= chunk_head.size:
        opcode, _, start, end, _, _, compression_length, _ = chunk_head.unpack_from(rest)
        if opcode == Opcode.CHUNK and compression_length == 0:
            remains = _remains(rest[chunk_head.size :], digests, (start, end))
            return Stretch(
                offset,
                len(rest),
                "cut",
                remains.records,
                remains.unread_bytes,
                remains.doubtful,
            )
    return Stretch(offset, len(rest), "cut", (), len(rest))


@dataclass
class _Remains:
    """What is left of a chunk whose own checksum does not hold."""

    records: tuple[McapRecord, ...] = ()
    doubtful: tuple[Message, ...] = ()
    unread_bytes: int = 0

    @property
    def messages(self) -> bool:
        return bool(self.doubtful) or any(isinstance(one, Message) for one in self.records)


def _remains(data: bytes, digests: frozenset[bytes], times: tuple[int, int]) -> _Remains:
    """Walk a chunk's records, and past what is broken to the next one that proves itself.

    A message proves itself by its checksum, where the file has any, and else by a time of reception
    that lies within the chunk's.
    """
    proved: list[McapRecord] = []
    doubtful: list[Message] = []
    unread = offset = 0
    while offset < len(data):
        record = _record_at(data, offset)
        if isinstance(record, Message) and _proves_itself(record, digests, times):
            (proved if digests else doubtful).append(record)
            offset += _length_at(data, offset)
        elif isinstance(record, Schema | Channel):
            proved.append(record)
            offset += _length_at(data, offset)
        else:
            following = _next_inner(data, offset, digests, times)
            unread += following - offset
            offset = following
    if digests and not any(isinstance(record, Message) for record in proved):
        return _remains(data, frozenset(), times)  # they are another chunk's: the record was lost
    return _Remains(tuple(proved), tuple(doubtful), unread)


def _next_inner(data: bytes, offset: int, digests: frozenset[bytes], times: tuple[int, int]) -> int:
    """Where the next record of a damaged chunk is that proves itself; its end where none does."""
    record = _record_at(data, offset)
    if isinstance(record, Message):
        # A payload alone may be damaged: then the record behind it stands where its length says.
        behind = offset + _length_at(data, offset)
        if behind == len(data) or _is_inner(_record_at(data, behind), digests, times):
            return behind
    for match in _INNER_ANCHOR.finditer(data, offset + 1):
        if _is_inner(_record_at(data, match.start()), digests, times):
            return match.start()
    return len(data)


def _is_inner(record: McapRecord | None, digests: frozenset[bytes], times: tuple[int, int]) -> bool:
    if isinstance(record, Message):
        return _proves_itself(record, digests, times)
    return isinstance(record, Schema | Channel)


def _proves_itself(message: Message, digests: frozenset[bytes], times: tuple[int, int]) -> bool:
    if not digests:
        return times[0] <= message.log_time <= times[1]
    return (
        digest(
            message.channel_id,
            message.sequence,
            message.log_time,
            message.publish_time,
            message.data,
        )
        in digests
    )


def _checked_records(chunk: Chunk) -> tuple[McapRecord, ...] | None:
    try:
        stream, length = get_chunk_data_stream(chunk, validate_crc=True)
        records, read = _inner_records(stream.read(length))
    except DAMAGE:
        return None
    return records if read == length else None


def _inner_records(data: bytes) -> tuple[tuple[McapRecord, ...], int]:
    records: list[McapRecord] = []
    offset = 0
    while isinstance(record := _record_at(data, offset), _IN_CHUNKS):
        records.append(record)
        offset += _length_at(data, offset)
    return tuple(records), offset


def _next_anchor(data: Bytes, offset: int) -> int | None:
    for match in _ANCHOR.finditer(data, offset):
        place = match.start()
        record = _record_at(data, place) if _fits_its_length(data, place) else None
        if record is None or (isinstance(record, Chunk) and _checked_records(record) is None):
            continue
        return place
    return None


def _fits_its_length(data: Bytes, offset: int) -> bool:
    """Whether the lengths inside an anchor add up to its own: cheap, however long it says it is."""
    opcode, body = data[offset], offset + HEADER_BYTES
    length = _length_at(data, offset) - HEADER_BYTES
    try:
        if opcode == Opcode.CHUNK:
            compression = struct.unpack_from("<I", data, body + 28)[0]
            inner = 40 + compression + struct.unpack_from("<Q", data, body + 32 + compression)[0]
        elif opcode == Opcode.METADATA:
            name = struct.unpack_from("<I", data, body)[0]
            inner = 8 + name + struct.unpack_from("<I", data, body + 4 + name)[0]
        else:
            inner = 4 if opcode == Opcode.DATA_END else 20
    except struct.error:
        return False
    return bool(inner == length)


def _length_at(data: Bytes, offset: int) -> int:
    """Bytes of the whole record at ``offset``, its header included."""
    length: int = struct.unpack_from("<Q", data, offset + 1)[0]
    return HEADER_BYTES + length


def _record_at(data: Bytes, offset: int) -> McapRecord | None:
    """The record that fills its declared length exactly, or None."""
    if offset + HEADER_BYTES > len(data):
        return None
    length = _length_at(data, offset)
    if offset + length > len(data):
        return None
    body = data[offset + HEADER_BYTES : offset + length]
    opcode = data[offset]
    if opcode == Opcode.MESSAGE:
        if len(body) < MESSAGE_BYTES:
            return None
        message: Message = Message.read(ReadDataStream(BytesIO(body)), len(body))
        return message
    reader = _READERS.get(opcode)
    if reader is None:
        return None
    stream = ReadDataStream(BytesIO(body))
    try:
        record = reader(stream)
    except DAMAGE:
        return None
    return record if stream.count == len(body) else None
