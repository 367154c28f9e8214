"""MCAP records, read one by one from bytes that may be damaged."""

import mmap
import struct
import zlib
from collections.abc import Callable
from io import BytesIO
from typing import TypeAlias

from inhand_runtime.recording import DAMAGE
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

Bytes: TypeAlias = bytes | mmap.mmap

HEADER_BYTES = 9
"""Of every record: the opcode and the length."""
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


def record_at(data: Bytes, offset: int) -> McapRecord | None:
    """The record that fills its declared length exactly, or None."""
    if offset + HEADER_BYTES > len(data):
        return None
    length = length_at(data, offset)
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


def message_head(data: Bytes, offset: int) -> Message | None:
    """The message that begins at ``offset``, without its payload, wherever that ends; or None."""
    start = offset + HEADER_BYTES
    if start + MESSAGE_BYTES > len(data) or data[offset] != Opcode.MESSAGE:
        return None
    stream = ReadDataStream(BytesIO(data[start : start + MESSAGE_BYTES]))
    head: Message = Message.read(stream, MESSAGE_BYTES)
    return head


def attachment_is_sound(data: Bytes, offset: int) -> bool:
    """Whether the checksum of the attachment at ``offset`` fits it, if it has one; MCAP's library
    does not look."""
    end = offset + length_at(data, offset)
    (checksum,) = struct.unpack_from("<I", data, end - 4)
    return checksum in (0, zlib.crc32(data[offset + HEADER_BYTES : end - 4]))


def length_at(data: Bytes, offset: int) -> int:
    """Bytes of the whole record at ``offset``, its header included."""
    length: int = struct.unpack_from("<Q", data, offset + 1)[0]
    return HEADER_BYTES + length


def inner_records(data: bytes) -> tuple[tuple[McapRecord, ...], int]:
    records: list[McapRecord] = []
    offset = 0
    while isinstance(record := record_at(data, offset), _IN_CHUNKS):
        records.append(record)
        offset += length_at(data, offset)
    return tuple(records), offset


def checked_records(chunk: Chunk) -> tuple[McapRecord, ...] | None:
    try:
        stream, length = get_chunk_data_stream(chunk, validate_crc=True)
        records, read = inner_records(stream.read(length))
    except DAMAGE:
        return None
    return records if read == length else None
