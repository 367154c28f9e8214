"""Where in a recording's file a time of capture is, found by a few of its chunks.

Times of capture grow through a file but where a clock was set back, which the times of reception of
its chunks show; so they are looked for by halves within each stretch in which those grow.
"""

from bisect import bisect_left
from collections.abc import Collection, Iterator, Sequence
from typing import IO

from mcap.data_stream import ReadDataStream
from mcap.records import Chunk, ChunkIndex
from mcap.records import Message as MessageRecord
from mcap.stream_reader import breakup_chunk
from mcap.summary import Summary

from inhand_runtime.recording.layout import REORDERED_NS

_HEADER_BYTES = 9
"""Bytes of a record before its contents: its opcode and its length."""


class CaptureTimes:
    """Times of capture in an open file of ours, of the channels with the given keys.

    Every method raises what the MCAP library raises on damaged bytes (``DAMAGE``), or OSError.
    """

    def __init__(self, file: IO[bytes], summary: Summary, keys: Collection[str]) -> None:
        self._file = file
        self._channels = {one.id for one in summary.channels.values() if one.topic in keys}
        in_order = sorted(summary.chunk_indexes, key=lambda one: one.chunk_start_offset)
        self._chunks = [one for one in in_order if self._may_hold(one)]

    def first_received(self) -> int | None:
        """Return when the oldest message of the first chunk was received; None without any."""
        for index in self._chunks:
            if messages := self._messages(index):
                return min(message.log_time for message in messages)
        return None

    def last(self) -> int | None:
        """Return when the newest message of the last chunk was captured; None without any."""
        newest = map(self._newest, reversed(self._chunks))
        return next((time_ns for time_ns in newest if time_ns is not None), None)

    def chunks_from(self, time_ns: int) -> list[ChunkIndex]:
        """Return the chunks that hold what was captured from the first message at or after a time
        on, in the order of the file, and a second before them."""
        first = 0
        for stretch in _stretches(self._chunks):
            if (self._newest(stretch[-1]) or 0) >= time_ns:
                found = bisect_left(stretch, time_ns, key=lambda one: self._newest(one) or 0)
                begin_ns = stretch[found].message_start_time - REORDERED_NS
                while found and stretch[found - 1].message_end_time >= begin_ns:
                    found -= 1
                return self._chunks[first + found :]
            first += len(stretch)
        return []

    def _may_hold(self, chunk: ChunkIndex) -> bool:
        """Whether messages of the channels are in a chunk, as far as its index says."""
        offsets = chunk.message_index_offsets
        return not offsets or bool(self._channels & offsets.keys())

    def _newest(self, index: ChunkIndex) -> int | None:
        return max((one.publish_time for one in self._messages(index)), default=None)

    def _messages(self, index: ChunkIndex) -> list[MessageRecord]:
        self._file.seek(index.chunk_start_offset + _HEADER_BYTES)
        chunk = Chunk.read(ReadDataStream(self._file))
        return [
            record
            for record in breakup_chunk(chunk, validate_crc=True)
            if isinstance(record, MessageRecord) and record.channel_id in self._channels
        ]


def _stretches(chunks: Sequence[ChunkIndex]) -> Iterator[list[ChunkIndex]]:
    """Part chunks where the clock of reception was set back."""
    stretch: list[ChunkIndex] = []
    for chunk in chunks:
        if stretch and chunk.message_start_time < stretch[-1].message_start_time - REORDERED_NS:
            yield stretch
            stretch = []
        stretch.append(chunk)
    if stretch:
        yield stretch
