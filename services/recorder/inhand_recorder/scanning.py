"""Walks an MCAP file that may be whole, cut off or damaged, and finds all that is left.

What a checksum contradicts is not handed out. Where the structure is lost, the walk goes on at
the next record that proves itself.
"""

import mmap
import os
import re
import struct
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, TypeAlias

from inhand_runtime.recording import RecordingError
from inhand_runtime.recording.checksums import (
    CHECKSUMS_RECORD,
    NO_CHECKSUMS,
    Checksums,
    parse_channels,
    parse_checksums,
)
from inhand_runtime.recording.chunk_walk import size_without_zeros
from inhand_runtime.recording.opening import opening
from mcap.opcode import Opcode
from mcap.records import (
    Channel,
    Chunk,
    Footer,
    McapRecord,
    Message,
    Metadata,
)
from mcap.writer import MCAP0_MAGIC as MAGIC

from inhand_recorder.records import HEADER_BYTES, Bytes, checked_records, length_at, record_at
from inhand_recorder.remains import Remains, remains_of

State: TypeAlias = Literal["whole", "cut", "damaged"]

FOOTER_BYTES = HEADER_BYTES + 20

# The start of a chunk, metadata, end of data or footer: opcode, then a length below 2 ** 40.
_ANCHOR = re.compile(rb"(?=[\x06\x0c\x0f\x02][\s\S]{5}\x00\x00\x00)")


@dataclass(frozen=True)
class Stretch:
    """A part of a file, and what could be read of it.

    A ``whole`` stretch is one record, or a chunk's records when their checksum holds. Of a ``cut``
    or ``damaged`` chunk ``records`` are the messages whose own checksum holds, and what it defines
    (schemas and channels); ``doubtful`` are messages that none covers. What a checksum contradicts
    is among ``unread_bytes``, and its head among ``broken``; ``cut_off`` is the head of the message
    in which the file ends. ``expected`` is the number of messages that were written there, where
    the checksums before it say so.
    """

    offset: int
    length: int
    state: State
    records: tuple[McapRecord, ...] = ()
    unread_bytes: int = 0
    doubtful: tuple[Message, ...] = ()
    broken: tuple[Message, ...] = ()
    cut_off: tuple[Message, ...] = ()
    expected: int | None = None


@contextmanager
def opened(path: Path) -> Iterator[Bytes]:
    """The bytes of a recording in any state; raises RecordingError when it is none.

    Zeros at the end, where a power cut left room without data, are not handed out.
    """
    with opening(path), path.open("rb") as file:
        size = size_without_zeros(file.fileno(), os.fstat(file.fileno()).st_size)
        if size == 0:
            raise RecordingError(f"{path} is empty: nothing was recorded into it; delete it")
        with mmap.mmap(file.fileno(), size, access=mmap.ACCESS_READ) as data:
            _require_recording(path, data)
            yield data


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
    footer = record_at(data, end - FOOTER_BYTES)
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
    footer = record_at(data, len(data) - len(MAGIC) - FOOTER_BYTES)
    return isinstance(footer, Footer) and footer.summary_crc != 0


def channels(data: Bytes) -> dict[int, Channel]:
    """The channels by their number, from wherever they still stand in the file.

    Whom a checksum proves comes first: that of the index, of a whole chunk, or their own beside the
    messages' checksums.
    """
    found: dict[int, Channel] = {}
    proved: dict[int, Channel] = {}
    doubtful: dict[int, Channel] = {}
    index = summary_start(data)
    for start in (index, len(MAGIC)):
        for stretch in scan(data, start) if start is not None else ():
            of_chunk = stretch.state == "whole" and data[stretch.offset] == Opcode.CHUNK
            place = found if of_chunk or start == index else doubtful
            for record in stretch.records:
                if isinstance(record, Channel):
                    place.setdefault(record.id, record)
                elif isinstance(record, Metadata) and record.name == CHECKSUMS_RECORD:
                    for number, (key, encoding) in parse_channels(record.metadata).items():
                        proved[number] = Channel(number, key, encoding, {}, 0)
        if found:  # an index need not repeat the channels: then the data says them
            break
    return doubtful | proved | found


def scan(data: Bytes, offset: int = len(MAGIC)) -> Iterator[Stretch]:
    """All stretches from ``offset`` on, without a hole between them."""
    end = len(data) - len(MAGIC) if data[-len(MAGIC) :] == MAGIC else len(data)
    checksums = NO_CHECKSUMS
    while offset < end:
        stretch = _stretch_at(data, offset, checksums)
        yield stretch
        # Checksums are those of the chunk behind them, and of no other.
        if data[offset] == Opcode.CHUNK or stretch.state != "whole":
            checksums = NO_CHECKSUMS
        for record in stretch.records:
            if isinstance(record, Metadata) and record.name == CHECKSUMS_RECORD:
                checksums = parse_checksums(record.metadata)
        offset += stretch.length
    if checksums:  # the file ends between a chunk's checksums and the chunk
        yield Stretch(end, 0, "cut", expected=checksums.count)


def _stretch_at(data: Bytes, offset: int, checksums: Checksums) -> Stretch:
    record = record_at(data, offset)
    if isinstance(record, Chunk):
        return _chunk(record, offset, length_at(data, offset), checksums)
    if record is not None:
        return Stretch(offset, length_at(data, offset), "whole", (record,))
    anchor = _next_anchor(data, offset + 1)
    if anchor is not None:
        length, expected = anchor - offset, checksums.count or None
        return Stretch(offset, length, "damaged", unread_bytes=length, expected=expected)
    return _cut(data, offset, checksums)


def _chunk(chunk: Chunk, offset: int, length: int, checksums: Checksums) -> Stretch:
    records = checked_records(chunk)
    if records is not None:
        return Stretch(offset, length, "whole", records)
    if chunk.compression:
        return Stretch(offset, length, "damaged", unread_bytes=length)
    times = chunk.message_start_time, chunk.message_end_time
    remains = remains_of(chunk.data, checksums, times)
    unread = length if not remains.messages else remains.unread_bytes
    return _left(offset, length, "damaged", remains, unread, checksums)


def _cut(data: Bytes, offset: int, checksums: Checksums) -> Stretch:
    rest = data[offset:]
    chunk_head = struct.Struct("<BQQQQIIQ")
    if len(rest) >= chunk_head.size:
        opcode, _, start, end, _, _, compression_length, _ = chunk_head.unpack_from(rest)
        if opcode == Opcode.CHUNK and compression_length == 0:
            remains = remains_of(rest[chunk_head.size :], checksums, (start, end))
            return _left(offset, len(rest), "cut", remains, remains.unread_bytes, checksums)
    expected = checksums.count or None
    return Stretch(offset, len(rest), "cut", unread_bytes=len(rest), expected=expected)


def _left(
    offset: int,
    length: int,
    state: State,
    remains: Remains,
    unread_bytes: int,
    checksums: Checksums,
) -> Stretch:
    return Stretch(
        offset,
        length,
        state,
        remains.records,
        unread_bytes,
        remains.doubtful,
        remains.broken,
        remains.cut_off,
        checksums.count or None,
    )


def _next_anchor(data: Bytes, offset: int) -> int | None:
    for match in _ANCHOR.finditer(data, offset):
        place = match.start()
        record = record_at(data, place) if _fits_its_length(data, place) else None
        if record is None or (isinstance(record, Chunk) and checked_records(record) is None):
            continue
        return place
    return None


def _fits_its_length(data: Bytes, offset: int) -> bool:
    """Whether the lengths inside an anchor add up to its own: cheap, however long it says it is."""
    opcode, body = data[offset], offset + HEADER_BYTES
    length = length_at(data, offset) - HEADER_BYTES
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
