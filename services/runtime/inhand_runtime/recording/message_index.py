"""Random access to the messages of a recording: any one by its number, without reading others.

``open_index`` reads a recording's index, however long it is, and no message. One without an index,
as it was cut off or still grows, is walked through once.
"""

import os
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from io import BytesIO
from pathlib import Path
from typing import NamedTuple, overload

import numpy as np
from inhand_schemas.topics import RGBD, AnyTopic
from mcap.data_stream import ReadDataStream
from mcap.records import Header
from mcap.writer import MCAP0_MAGIC

from inhand_runtime.recording.chunk_table import ChunkTable, Entries, IndexedTable, Integers
from inhand_runtime.recording.chunk_walk import WalkedTable
from inhand_runtime.recording.coded_colour import (
    LONGEST_CHAIN,
    CodedPicture,
    ColourDecoder,
    coded_image,
)
from inhand_runtime.recording.layout import (
    APART_ENCODING,
    HEADER,
    MESSAGE_ENCODING,
    PROFILE,
    SEQUENCE_MASK,
    RecordedMessage,
    RecordingError,
)
from inhand_runtime.recording.message_reader import MISPLACED, MessageReader
from inhand_runtime.recording.opening import opening
from inhand_runtime.recording.reading import (
    apart_channels,
    choose_channels,
    explaining_damage,
    in_order_of_reception,
)

_OFFSET_BITS = 40
"""Bits that hold a place in a chunk, or in a file without chunks: one of up to a terabyte."""


class _Key(NamedTuple):
    """A key, the numbers of its channels, its topic and the name in it, and whether these hold what
    could not be read on it."""

    key: str
    channels: tuple[int, ...]
    topic: AnyTopic
    name: str
    apart: bool = False


@dataclass(frozen=True)
class Stamps:
    """The numbers, their lowest 32 bits, and times of capture in nanoseconds of N messages."""

    sequences: Integers
    captured_ns: Integers


class RecordingIndex:
    """The messages of an open recording by stream and name; several threads may read at a time.

    ``note`` says that a file was cut off, and the mend; it is None of a whole one.
    """

    def __init__(self, path: Path, descriptor: int) -> None:
        """Index an open file; raises RecordingError for one that is empty, foreign or damaged."""
        self.path = path
        size = os.fstat(descriptor).st_size
        _require_recording(path, os.pread(descriptor, len(MCAP0_MAGIC), 0))
        with explaining_damage(path):
            self.ours = _profile(descriptor) == PROFILE
            self._table, self.note = _table(path, descriptor, size)
        self._reader = MessageReader(descriptor, size, self._table.chunks)
        self._keys = _keys(self._table)
        self._apart = _keys_apart(self._table)

    def counts(self, stream: str) -> dict[str, int]:
        """Return the numbers of messages of a stream by their names: of cameras, objects, …"""
        counts: Counter[str] = Counter()
        for one in self._keys:
            if one.topic.stream == stream:
                counts[one.name] += sum(map(self._table.count, one.channels))
        return dict(counts)

    def keys(self) -> dict[str, AnyTopic]:
        """Return the keys of Inhand's with their topics."""
        return {one.key: one.topic for one in self._keys}

    @property
    def apart(self) -> dict[str, int]:
        """Numbers of messages that are kept apart, as they could not be read on their keys, by
        these."""
        return {one.key: sum(map(self._table.count, one.channels)) for one in self._apart}

    def apart_of(self, key: str) -> "IndexedMessages":
        """Return the messages that are kept apart of a key; raises RecordingError where the index
        is damaged."""
        return self._messages(next((one for one in self._apart if one.key == key), None))

    def count(self, key: str) -> int:
        """Return the number of messages of a key."""
        found = [one for one in self._keys if one.key == key]
        return sum(self._table.count(channel) for one in found for channel in one.channels)

    def messages_of(self, key: str) -> "IndexedMessages":
        """Return the messages of one key; raises RecordingError where the index is damaged."""
        return self._messages(next((one for one in self._keys if one.key == key), None))

    def messages(self, stream: str, name: str) -> "IndexedMessages":
        """Return the messages of a stream by their numbers; none where there are none.

        They are in the order in which ``read_recording`` yields them. Raises RecordingError.
        """
        found = [one for one in self._keys if (one.topic.stream, one.name) == (stream, name)]
        if len(found) > 1:
            keys = ", ".join(sorted(one.key for one in found))
            raise RecordingError(
                f"{self.path} holds {stream} of {name} on {len(found)} keys ({keys}): give a "
                "recording of one rig"
            )
        return self._messages(found[0] if found else None)

    def _messages(self, key: _Key | None) -> "IndexedMessages":
        with explaining_damage(self.path):
            parts = [self._table.entries(one) for one in (key.channels if key else ())]
        return IndexedMessages(self, key, self._in_order(_joined(parts)))

    def read(self, key: _Key, chunk: int, offset: int) -> RecordedMessage:
        """Read one message; raises RecordingError where a checksum contradicts it."""
        with explaining_damage(self.path):
            stamp, payload = self._reader.read(chunk, offset)
        if stamp.channel not in key.channels:
            raise RecordingError(f"{self.path}: {MISPLACED}")
        times = stamp.received_ns, stamp.captured_ns
        named = key.key, key.topic, key.name
        return RecordedMessage(*named, payload, *times, stamp.sequence, apart=key.apart)

    def stamps(self, entries: Entries) -> Stamps:
        """Read the stamps of messages without their payloads; raises RecordingError."""
        with explaining_damage(self.path):
            sequences, captured_ns = self._reader.stamps(entries)
        return Stamps(np.array(sequences, np.int64), np.array(captured_ns, np.int64))

    def _in_order(self, entries: Entries) -> Entries:
        times = entries.received_ns
        if (np.diff(times) >= 0).all():
            return entries
        if self.ours:
            numbered = zip(times.tolist(), range(len(times)), strict=True)
            order = np.array(list(in_order_of_reception(numbered)))
        else:
            order = np.argsort(times, kind="stable")
        return Entries(entries.chunks[order], times[order], entries.offsets[order])


class IndexedMessages(Sequence[RecordedMessage]):
    """The N messages of one key; one is read when it is asked for. ``received_ns`` is (N,)."""

    def __init__(self, index: RecordingIndex, key: _Key | None, entries: Entries) -> None:
        self._index, self._key, self._entries = index, key, entries
        self._decoder = ColourDecoder()
        self.received_ns = entries.received_ns

    def __len__(self) -> int:
        return len(self.received_ns)

    @overload
    def __getitem__(self, number: int) -> RecordedMessage: ...
    @overload
    def __getitem__(self, number: slice) -> list[RecordedMessage]: ...
    def __getitem__(self, number: int | slice) -> RecordedMessage | list[RecordedMessage]:
        """Read a message, or some; raises RecordingError, and IndexError beyond the last one."""
        if isinstance(number, slice):
            return [self[one] for one in range(*number.indices(len(self)))]
        if self._key is None or not -len(self) <= number < len(self):
            raise IndexError(f"there are {len(self)} messages, and none of number {number}")
        message = self._read(self._key, number)
        if message.topic is not RGBD:
            return message
        return replace(message, coded=self._coded(message, number))

    def _read(self, key: _Key, number: int) -> RecordedMessage:
        entry = int(self._entries.chunks[number]), int(self._entries.offsets[number])
        message = self._index.read(key, *entry)
        if message.received_ns != int(self.received_ns[number]):
            raise RecordingError(f"{self._index.path}: {MISPLACED}")
        return message

    def _coded(self, message: RecordedMessage, number: int) -> CodedPicture | None:
        """Return the colour of a message where that is H.264."""
        number %= len(self)
        image = coded_image(message.payload)
        if image is None:
            return None
        return CodedPicture(image, lambda: self._coded_before(number), self._decoder)

    def _coded_before(self, number: int) -> CodedPicture | None:
        """Read the last colour before a message that is H.264; None where that is far away."""
        if self._key is None:
            return None
        for one in range(number - 1, max(-1, number - 1 - LONGEST_CHAIN), -1):
            coded = self._coded(self._read(self._key, one), one)
            if coded is not None:
                return coded
        return None

    @cached_property
    def places(self) -> Integers:
        """Numbers (N,) that order messages of several keys as they stand in the file."""
        return self._entries.chunks << _OFFSET_BITS | self._entries.offsets

    @cached_property
    def stamps(self) -> Stamps:
        """The numbers and times of capture of all messages, read once, without payloads.

        Other programs' files may have other times beside their messages: there every message is
        decoded. Raises RecordingError, and MessageError.
        """
        if self._index.ours:
            return self._index.stamps(self._entries)
        decoded = [one.message() for one in self]
        return Stamps(
            np.array([one.sequence & SEQUENCE_MASK for one in decoded], np.int64),
            np.array([one.time_ns for one in decoded], np.int64),
        )

    def captured_at(self, time_ns: int) -> int | None:
        """Return the number of the message that was captured last until a time; None before the
        first. Where a clock was set back it is the nearest one."""
        captured = self.stamps.captured_ns
        if not len(captured) or time_ns < captured.min():
            return None
        if (np.diff(captured) >= 0).all():
            return int(np.searchsorted(captured, time_ns, side="right")) - 1
        return int(np.argmin(np.abs(captured - time_ns)))


@contextmanager
def open_index(path: Path) -> Iterator[RecordingIndex]:
    """Open a recording for random access while a block runs.

    Raises RecordingError for a file that is missing, foreign or damaged, and UnknownVersionError.
    """
    with opening(path):
        descriptor = os.open(path, os.O_RDONLY)
    try:
        yield RecordingIndex(path, descriptor)
    finally:
        os.close(descriptor)


def _require_recording(path: Path, head: bytes) -> None:
    if not head:
        raise RecordingError(f"{path} is empty: nothing was recorded into it; delete it")
    if head != MCAP0_MAGIC:
        raise RecordingError(f"{path} is no recording: give a .mcap or .mcap.part file")


def _profile(descriptor: int) -> str:
    """Return the name of the layout that a file's header says."""
    start = len(MCAP0_MAGIC)
    _, length = HEADER.unpack(os.pread(descriptor, HEADER.size, start))
    body = os.pread(descriptor, min(length, 1 << 16), start + HEADER.size)
    return str(Header.read(ReadDataStream(BytesIO(body))).profile)


def _table(path: Path, descriptor: int, size: int) -> tuple[ChunkTable, str | None]:
    """Return where all messages are, and what is to be known of it."""
    tail = os.pread(descriptor, len(MCAP0_MAGIC), max(0, size - len(MCAP0_MAGIC)))
    finished = tail == MCAP0_MAGIC and size > 2 * len(MCAP0_MAGIC)
    if finished:
        indexed = IndexedTable(descriptor, size)
        if indexed.complete:
            return indexed, None
    walked = WalkedTable(descriptor, size)
    if not walked.channels and not finished:
        raise RecordingError(f"{path} was cut off before any message: there is nothing to show")
    if finished:
        return walked, None
    return walked, f"{path} was cut off: `inhand recording recover {path}` saves what is left"


def _keys(table: ChunkTable) -> list[_Key]:
    """Find the keys of Inhand's with all their channels; raises UnknownVersionError."""
    numbers = _numbers(table, MESSAGE_ENCODING)
    chosen = choose_channels(table.channels.values())
    return [
        _Key(key, tuple(numbers[key]), topic, parsed.name)
        for key, (topic, parsed) in chosen.items()
    ]


def _keys_apart(table: ChunkTable) -> list[_Key]:
    """Find the keys of which messages are kept apart."""
    numbers = _numbers(table, APART_ENCODING)
    chosen = apart_channels(table.channels.values())
    return [
        _Key(key, tuple(numbers[key]), topic, parsed.name, apart=True)
        for key, (topic, parsed) in chosen.items()
    ]


def _numbers(table: ChunkTable, encoding: str) -> dict[str, list[int]]:
    """Return the numbers of the channels of an encoding by their keys."""
    numbers: dict[str, list[int]] = {}
    for number, channel in table.channels.items():
        if channel.message_encoding == encoding:
            numbers.setdefault(channel.topic, []).append(number)
    return numbers


def _joined(parts: list[Entries]) -> Entries:
    """Join the messages of several channels in the order of the file."""
    if len(parts) == 1:
        return parts[0]
    fields = ("chunks", "received_ns", "offsets")
    nothing = np.zeros(0, np.int64)
    chunks, received_ns, offsets = (
        np.concatenate([nothing, *(getattr(part, name) for part in parts)]) for name in fields
    )
    order = np.lexsort((offsets, chunks))
    return Entries(chunks[order], received_ns[order], offsets[order])
