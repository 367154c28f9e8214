"""Where the messages of a recording stand in its file, found by a walk through it.

It is for files that have no index, as they were cut off or still grow. Heads of records are read,
and no payloads, so that a walk takes a small part of the time of reading.
"""

import os
import struct
from collections.abc import Iterator
from io import BytesIO

import numpy as np
from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk
from mcap.stream_reader import get_chunk_data_stream
from mcap.writer import MCAP0_MAGIC

from inhand_runtime.recording.checksums import CHECKSUMS_RECORD
from inhand_runtime.recording.chunk_table import (
    CHUNK_HEAD,
    Chunks,
    Entries,
    chunks_of,
    read_channel,
)
from inhand_runtime.recording.layout import DAMAGE, HEADER, MESSAGE_HEAD

FILE_ITSELF = -1
"""Start of what counts as the chunk of messages that stand in none: the whole file."""
_READ_BYTES = 1 << 16
_SHORTEST = {
    Opcode.SCHEMA: 0,
    Opcode.CHANNEL: 0,
    Opcode.MESSAGE: MESSAGE_HEAD.size - HEADER.size,
}
"""Least length of the records that stand in chunks."""
_CHECKSUMS = struct.pack("<I", len(CHECKSUMS_RECORD)) + CHECKSUMS_RECORD.encode()


class WalkedTable:
    """What a walk through an open file of ``size`` bytes found, up to its end, or to a record that
    is damaged; of a chunk that is cut off, the messages that are whole."""

    def __init__(self, descriptor: int, size: int) -> None:
        self._descriptor, self._size = descriptor, size_without_zeros(descriptor, size)
        self.channels: dict[int, Channel] = {}
        self._found: dict[int, list[tuple[int, int, int]]] = {}
        self.chunks = self._walk()

    def count(self, channel: int) -> int:
        """Return the number of messages of a channel."""
        return len(self._found.get(channel, ()))

    def entries(self, channel: int) -> Entries:
        """Return where the messages of a channel are."""
        found = np.array(self._found.get(channel, ()), np.int64).reshape(-1, 3)
        return Entries(found[:, 0], found[:, 1], found[:, 2])

    def _walk(self) -> Chunks:
        rows: list[tuple[int, int, bool, int]] = [(FILE_ITSELF, 0, False, -1)]
        checksums = -1
        for opcode, start, end in self._records():
            body = start + HEADER.size
            if opcode == Opcode.CHUNK:
                row = self._chunk(len(rows), start, min(end, self._size))
                if row is not None:
                    rows.append((*row, checksums))
                checksums = -1
            elif opcode == Opcode.METADATA:
                named = os.pread(self._descriptor, len(_CHECKSUMS), body) == _CHECKSUMS
                checksums = start if named and end <= self._size else -1
            elif opcode in (Opcode.MESSAGE, Opcode.CHANNEL) and end <= self._size:
                self._take_one(0, start, os.pread(self._descriptor, end - start, start))
        return chunks_of(rows)

    def _records(self) -> Iterator[tuple[int, int, int]]:
        """Yield the opcode, start and end of each record; the last one's end may be beyond the
        file's."""
        position = len(MCAP0_MAGIC)
        while position + HEADER.size <= self._size:
            opcode, length = HEADER.unpack(os.pread(self._descriptor, HEADER.size, position))
            if not Opcode.HEADER <= opcode <= Opcode.DATA_END or length > 1 << 40:
                return
            yield opcode, position, position + HEADER.size + length
            if opcode == Opcode.DATA_END:
                return
            position += HEADER.size + length

    def _chunk(self, number: int, start: int, end: int) -> tuple[int, int, bool] | None:
        """Walk a chunk, of which the file holds the bytes from ``start`` to ``end``; None where
        even its head is cut off, or what is compressed is not whole."""
        head = start + HEADER.size
        fixed = os.pread(self._descriptor, CHUNK_HEAD.size, head)
        if len(fixed) < CHUNK_HEAD.size:
            return None
        *_, name_length = CHUNK_HEAD.unpack(fixed)
        contents = head + CHUNK_HEAD.size + name_length + 8
        if name_length == 0:
            self._take(number, _PlainBytes(self._descriptor, contents, end))
            return start, contents, False
        whole = os.pread(self._descriptor, end - start, start)
        data = unpacked(whole)
        if data is None:
            return None
        self._take(number, data)
        return start, contents, True

    def _take(self, number: int, data: "bytes | _PlainBytes") -> None:
        """Note the channels and whole messages in a chunk's contents."""
        position = 0
        while position + HEADER.size <= len(data):
            opcode, length = HEADER.unpack(data[position : position + HEADER.size])
            end = position + HEADER.size + length
            if end > len(data) or length < _SHORTEST.get(opcode, end):
                return
            wanted = end if opcode == Opcode.CHANNEL else position + MESSAGE_HEAD.size
            self._take_one(number, position, data[position : min(wanted, end)])
            position = end

    def _take_one(self, number: int, position: int, record: bytes) -> None:
        """Note a channel, or a message by its head."""
        if record[0] == Opcode.CHANNEL:
            found = read_channel(record[HEADER.size :])
            self.channels.setdefault(found.id, found)
        elif record[0] == Opcode.MESSAGE:
            _, _, channel, _, received_ns, _ = MESSAGE_HEAD.unpack_from(record)
            self._found.setdefault(channel, []).append((number, received_ns, position))


class _PlainBytes:
    """Bytes ``start`` to ``end`` of a file, read in blocks as they are asked for."""

    def __init__(self, descriptor: int, start: int, end: int) -> None:
        self._descriptor, self._start, self._end = descriptor, start, end
        self._block, self._at = b"", 0

    def __len__(self) -> int:
        return max(0, self._end - self._start)

    def __getitem__(self, part: slice) -> bytes:
        first, last = int(part.start), min(int(part.stop), len(self))
        if not self._at <= first <= last <= self._at + len(self._block):
            length = min(max(last - first, 256), _READ_BYTES)
            if last - first > length:
                return os.pread(self._descriptor, last - first, self._start + first)
            self._block = os.pread(
                self._descriptor, min(length, len(self) - first), self._start + first
            )
            self._at = first
        return self._block[first - self._at : last - self._at]


def size_without_zeros(descriptor: int, size: int) -> int:
    """Return the bytes of a file before the zeros at its end, where a power cut left room without
    data."""
    while size > 0:
        start = max(0, size - (1 << 20))
        block = os.pread(descriptor, size - start, start).rstrip(b"\0")
        if block:
            return start + len(block)
        size = start
    return 0


def unpacked(record: bytes) -> bytes | None:
    """Return the contents of a whole chunk's record; None where it is damaged."""
    try:
        chunk = Chunk.read(ReadDataStream(BytesIO(record[HEADER.size :])))
        stream, length = get_chunk_data_stream(chunk, validate_crc=True)
        return bytes(stream.read(length))
    except DAMAGE:
        return None
