"""Reads single messages of a recording from where they stand in its file, and checks them."""

import os
from functools import lru_cache
from io import BytesIO
from typing import NamedTuple

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Metadata

from inhand_runtime.recording.checksums import NO_CHECKSUMS, Checksums, parse_checksums
from inhand_runtime.recording.chunk_table import Chunks, Entries
from inhand_runtime.recording.chunk_walk import FILE_ITSELF, unpacked
from inhand_runtime.recording.layout import HEADER, MESSAGE_HEAD

MISPLACED = "a message is not where the file's index says"
_CHUNKS_KEPT = 4
"""Unpacked chunks that stay in memory, as neighbouring messages are often asked for."""
_CHECKSUMS_KEPT = 256
"""Chunks whose messages' checksums stay in memory."""
_MESSAGE_BYTES = MESSAGE_HEAD.size - HEADER.size


class Stamp(NamedTuple):
    """A message's channel, its number and its times in nanoseconds."""

    channel: int
    sequence: int
    received_ns: int
    captured_ns: int


class MessageReader:
    """Reads messages of an open file by their chunk and their offset in it.

    Everything raises what the MCAP library raises on damaged bytes (``DAMAGE``), or OSError.
    """

    def __init__(self, descriptor: int, size: int, chunks: Chunks) -> None:
        self._descriptor, self._size, self._chunks = descriptor, size, chunks
        self._checksums = lru_cache(_CHECKSUMS_KEPT)(self._read_checksums)
        self._contents = lru_cache(_CHUNKS_KEPT)(self._read_contents)

    def read(self, chunk: int, offset: int) -> tuple[Stamp, bytes]:
        """Read a message and its payload, of which a checksum holds, where there is any."""
        chunks = self._chunks
        if chunks.starts[chunk] == FILE_ITSELF:
            return self._read_plain(offset)
        checksums = NO_CHECKSUMS if chunks.compressed[chunk] else self._checksums(chunk)
        if not checksums:
            return _message_in(self._contents(chunk), offset)
        stamp, payload = self._read_plain(int(chunks.contents[chunk]) + offset)
        if not checksums.holds(*stamp, payload):
            raise McapError(f"the checksum of message {stamp.sequence} does not hold")
        return stamp, payload

    def stamps(self, entries: Entries) -> tuple[list[int], list[int]]:
        """Read the numbers and the times of capture of messages without their payloads."""
        chunks, descriptor, size = self._chunks, self._descriptor, MESSAGE_HEAD.size
        compressed = chunks.compressed[entries.chunks].tolist()
        places = (chunks.contents[entries.chunks] + entries.offsets).tolist()
        received, sequences, captured = [], [], []
        for index, place in enumerate(places):
            if compressed[index]:
                place, chunk = int(entries.offsets[index]), int(entries.chunks[index])
                head = self._contents(chunk)[place : place + size]
            else:
                head = os.pread(descriptor, size, place)
            _, _, _, sequence, received_ns, captured_ns = MESSAGE_HEAD.unpack(head)
            received.append(received_ns)
            sequences.append(sequence)
            captured.append(captured_ns)
        if received != entries.received_ns.tolist():
            raise McapError(MISPLACED)
        return sequences, captured

    def _read_plain(self, place: int) -> tuple[Stamp, bytes]:
        stamp, size = _stamp_of(os.pread(self._descriptor, MESSAGE_HEAD.size, place))
        if place + MESSAGE_HEAD.size + size > self._size:
            raise McapError("a message is longer than the file")
        return stamp, os.pread(self._descriptor, size, place + MESSAGE_HEAD.size)

    def _read_checksums(self, chunk: int) -> Checksums:
        """Read the checksums of a chunk's messages; none where it has none."""
        start = int(self._chunks.checksums[chunk])
        if start < 0:
            return NO_CHECKSUMS
        record = os.pread(self._descriptor, int(self._chunks.starts[chunk]) - start, start)
        metadata: Metadata = Metadata.read(ReadDataStream(BytesIO(record[HEADER.size :])))
        return parse_checksums(metadata.metadata)

    def _read_contents(self, chunk: int) -> bytes:
        """Read the contents of a whole chunk, of which the checksum holds."""
        start = int(self._chunks.starts[chunk])
        opcode, length = HEADER.unpack(os.pread(self._descriptor, HEADER.size, start))
        size = HEADER.size + length
        if opcode != Opcode.CHUNK or start + size > self._size:
            raise McapError("a chunk is not where the file's index says, or is cut off")
        contents = unpacked(os.pread(self._descriptor, size, start))
        if contents is None:
            raise McapError(f"the checksum of the chunk at byte {start} does not hold")
        return contents


def _message_in(contents: bytes, offset: int) -> tuple[Stamp, bytes]:
    """Return the message at an offset of a chunk's contents."""
    start = offset + MESSAGE_HEAD.size
    stamp, size = _stamp_of(contents[offset:start])
    if start + size > len(contents):
        raise McapError("a message is longer than its chunk")
    return stamp, contents[start : start + size]


def _stamp_of(head: bytes) -> tuple[Stamp, int]:
    """Return the stamp of a message by its head, and the bytes of its payload."""
    opcode, length, *stamp = MESSAGE_HEAD.unpack(head)
    if opcode != Opcode.MESSAGE or length < _MESSAGE_BYTES:
        raise McapError(MISPLACED)
    return Stamp(*stamp), length - _MESSAGE_BYTES
