"""Where the messages of a recording stand in its file, by its index.

MCAP's index says of each chunk of messages where it is, and where its own index of each channel is;
from the lengths of these follow the numbers of messages. No message is read for it.
"""

import os
import struct
import zlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from io import BytesIO
from typing import Protocol

import numpy as np
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel
from mcap.writer import MCAP0_MAGIC
from numpy.typing import NDArray

from inhand_runtime.recording.checksums import CHECKSUMS_RECORD
from inhand_runtime.recording.layout import HEADER

Integers = NDArray[np.int64]

CHUNK_HEAD = struct.Struct("<QQQII")
"""A chunk's first and last time, size, checksum, and the length of its compression's name."""
_CHUNK_INDEX = struct.Struct("<QQQQI")
_INDEX_ENTRY = struct.Struct("<HQ")
_FOOTER = struct.Struct("<QQI")
_LENGTHS = struct.Struct("<QI")
_MESSAGE_INDEX = struct.Struct("<BQHI")


@dataclass(frozen=True)
class Chunks:
    """C chunks in the order of the file: at which bytes their records start and their contents do,
    whether these are compressed, and where the record with their messages' checksums is, -1 without
    one, each (C,)."""

    starts: Integers
    contents: Integers
    compressed: NDArray[np.bool_]
    checksums: Integers


@dataclass(frozen=True)
class Entries:
    """N messages of one channel in the order of the file: the numbers of their chunks, their times
    of reception in nanoseconds, and where in their chunk's contents they start, each (N,)."""

    chunks: Integers
    received_ns: Integers
    offsets: Integers


class ChunkTable(Protocol):
    """Says where the messages of each channel are."""

    @property
    def channels(self) -> Mapping[int, Channel]:
        """The channels by their numbers."""

    @property
    def chunks(self) -> Chunks:
        """All chunks."""

    def count(self, channel: int) -> int:
        """Return the number of messages of a channel."""

    def entries(self, channel: int) -> Entries:
        """Return where the messages of a channel are; raises McapError where that is damaged."""


class IndexedTable:
    """The table that a whole file's own index holds."""

    def __init__(self, descriptor: int, size: int) -> None:
        """Read the index of an open file of ``size`` bytes; raises McapError where it has none, or
        a damaged one."""
        self._descriptor = descriptor
        self.channels: dict[int, Channel] = {}
        self._indexes: dict[int, list[tuple[int, int, int]]] = {}
        self.chunks = self._read(_summary(descriptor, size))

    @property
    def complete(self) -> bool:
        """Whether the index says where all messages are; much of it is optional in MCAP."""
        return len(self.chunks.starts) > 0 and set(self._indexes) <= set(self.channels)

    def count(self, channel: int) -> int:
        """Return the number of messages of a channel, by the lengths of its indexes."""
        return sum(_entries_in(length) for _, _, length in self._indexes.get(channel, ()))

    def entries(self, channel: int) -> Entries:
        """Read the indexes of a channel."""
        indexes = self._indexes.get(channel, ())
        parts = [self._entries(channel, start, length) for _, start, length in indexes]
        numbers = np.array([number for number, _, _ in indexes], np.int64)
        counts = [len(part) // _INDEX_PAIR for part in parts]
        pairs = np.frombuffer(b"".join(parts), "<i8").reshape(-1, 2)
        return Entries(np.repeat(numbers, counts), pairs[:, 0].copy(), pairs[:, 1].copy())

    def _entries(self, channel: int, start: int, length: int) -> bytes:
        data = os.pread(self._descriptor, length, start)
        if len(data) < _MESSAGE_INDEX.size:
            raise McapError("an index of messages is cut off")
        opcode, inner, number, size = _MESSAGE_INDEX.unpack_from(data)
        lengths = {inner + HEADER.size, size + _MESSAGE_INDEX.size}
        if (opcode, number, lengths) != (Opcode.MESSAGE_INDEX, channel, {len(data)}):
            raise McapError("an index of messages is not where the file's index says")
        return data[_MESSAGE_INDEX.size :]

    def _read(self, summary: bytes) -> Chunks:
        chunks: list[tuple[int, int, bool]] = []
        offsets: list[tuple[tuple[tuple[int, int], ...], int]] = []
        checksums: dict[int, int] = {}
        for opcode, start, end in _records(summary):
            if opcode == Opcode.CHUNK_INDEX:
                chunk, indexes = _chunk_index(summary, start)
                chunks.append(chunk)
                offsets.append(indexes)
            elif opcode == Opcode.CHANNEL:
                channel = read_channel(summary[start:end])
                self.channels[channel.id] = channel
            elif opcode == Opcode.METADATA_INDEX and summary[start + 20 : end] == _CHECKSUMS:
                place, length, _ = struct.unpack_from("<QQI", summary, start)
                checksums[place + length] = place
        order = sorted(range(len(chunks)), key=chunks.__getitem__)
        for number, index in enumerate(order):
            for channel_id, place, length in _lengths(*offsets[index]):
                self._indexes.setdefault(channel_id, []).append((number, place, length))
        return chunks_of([(*chunks[one], checksums.get(chunks[one][0], -1)) for one in order])


_INDEX_PAIR = 16
"""Bytes of a message's time and place in an index."""
_CHECKSUMS = CHECKSUMS_RECORD.encode()


def chunks_of(rows: list[tuple[int, int, bool, int]]) -> Chunks:
    """Make chunks of a row for each: start, contents, compressed, checksums."""
    starts, contents, compressed, checksums = zip(*rows, strict=True) if rows else ((), (), (), ())
    return Chunks(
        np.array(starts, np.int64),
        np.array(contents, np.int64),
        np.array(compressed, bool),
        np.array(checksums, np.int64),
    )


def read_channel(body: bytes) -> Channel:
    """Read the record of a channel without its header."""
    channel: Channel = Channel.read(ReadDataStream(BytesIO(body)))
    return channel


def _summary(descriptor: int, size: int) -> bytes:
    """Read the index's bytes; raises McapError where there is none, or a damaged one."""
    footer_bytes = HEADER.size + _FOOTER.size
    tail = os.pread(descriptor, footer_bytes + len(MCAP0_MAGIC), max(0, size - footer_bytes - 8))
    if len(tail) < footer_bytes or tail[0] != Opcode.FOOTER or tail[footer_bytes:] != MCAP0_MAGIC:
        raise McapError("the file has no end")
    start, _, checksum = _FOOTER.unpack_from(tail, HEADER.size)
    end = size - len(MCAP0_MAGIC) - footer_bytes
    if not 0 < start <= end:
        raise McapError("the file has no index")
    summary = os.pread(descriptor, end - start, start)
    if checksum and zlib.crc32(tail[: footer_bytes - 4], zlib.crc32(summary)) != checksum:
        raise McapError("the checksum of the file's index does not hold")
    return summary


def _records(data: bytes) -> Iterator[tuple[int, int, int]]:
    """Yield the opcode of each record, and where its body starts and ends."""
    position = 0
    while position + HEADER.size <= len(data):
        opcode, length = HEADER.unpack_from(data, position)
        position += HEADER.size
        if position + length > len(data):
            raise McapError("the file's index is cut off")
        yield opcode, position, position + length
        position += length


def _chunk_index(
    data: bytes, start: int
) -> tuple[tuple[int, int, bool], tuple[tuple[tuple[int, int], ...], int]]:
    """Return a chunk's start, contents and whether they are compressed; and its channels' indexes,
    each with where it starts, and where the last one ends."""
    _, _, chunk, chunk_length, length = _CHUNK_INDEX.unpack_from(data, start)
    start += _CHUNK_INDEX.size
    indexes = tuple(_INDEX_ENTRY.iter_unpack(data[start : start + length]))
    index_length, name_length = _LENGTHS.unpack_from(data, start + length)
    contents = chunk + HEADER.size + CHUNK_HEAD.size + name_length + 8
    return (chunk, contents, name_length > 0), (indexes, chunk + chunk_length + index_length)


def _lengths(indexes: tuple[tuple[int, int], ...], end: int) -> Iterator[tuple[int, int, int]]:
    """Yield channels with where their index in a chunk starts, and its length."""
    in_order = sorted(indexes, key=lambda one: one[1])
    ends = [*(place for _, place in in_order[1:]), end]
    for (channel, place), until in zip(in_order, ends, strict=True):
        yield channel, place, until - place


def _entries_in(length: int) -> int:
    return (length - _MESSAGE_INDEX.size) // _INDEX_PAIR
