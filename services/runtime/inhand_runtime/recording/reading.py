"""Reading whole recordings."""

import heapq
import os
from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO, TypeVar

from inhand_schemas.errors import KeyFormatError, UnknownVersionError
from inhand_schemas.keys import ParsedKey
from inhand_schemas.topics import RGBD, AnyTopic, topic_of
from mcap.reader import SeekingReader
from mcap.records import Channel
from mcap.records import Message as MessageRecord
from mcap.summary import Summary
from mcap.writer import MCAP0_MAGIC

from inhand_runtime.recording.checksums import CHECKSUMS_RECORD
from inhand_runtime.recording.coded_colour import LONGEST_CHAIN_NS, ColourChains
from inhand_runtime.recording.layout import (
    APART_ENCODING,
    DAMAGE,
    MESSAGE_ENCODING,
    PROFILE,
    REORDERED_NS,
    RecordedMessage,
    RecordingError,
)
from inhand_runtime.recording.opening import opening
from inhand_runtime.recording.seeking import CaptureTimes

Item = TypeVar("Item")


def read_recording(
    path: Path,
    *,
    streams: Collection[str] | None = None,
    captured_from_ns: int | None = None,
    apart: bool = False,
) -> Iterator[RecordedMessage]:
    """The messages of a whole recording in the order of their reception.

    Where the clock was set back while it was recorded, what stands later in the file comes later;
    in files of other writers the times alone say the order.

    ``streams`` chooses; keys that are not Inhand's are passed over. In files of ours most of what
    stands before the first message that was captured at or after ``captured_from_ns`` is not read,
    and so not yielded; nothing after it is left out, nor what colour after it builds on. With
    ``apart``, for copies, what could not be read on its key when it was recorded is yielded as
    well. Raises RecordingError for a file that is missing, foreign, cut off or damaged, and
    UnknownVersionError.
    """
    with _open(path) as (file, reader):
        summary = _summary(path, reader)
        chosen = choose_channels(summary.channels.values(), streams)
        if captured_from_ns is not None and _is_ours(path, reader) and summary.chunk_indexes:
            with explaining_damage(path):
                captured = CaptureTimes(file, summary, chosen)
                if not (chunks := captured.chunks_from(captured_from_ns)):
                    return
                if any(topic is RGBD for topic, _ in chosen.values()):
                    chunks = captured.chunks_from(captured_from_ns - LONGEST_CHAIN_NS)
            # The reader keeps this summary, and reads the chunks that it names.
            summary.chunk_indexes = chunks
        if apart:
            chosen = apart_channels(summary.channels.values(), streams) | chosen
        encodings = (MESSAGE_ENCODING, APART_ENCODING) if apart else (MESSAGE_ENCODING,)
        chains = ColourChains()
        for channel, message in _records(path, reader, chosen, encodings):
            topic, parsed = chosen[channel.topic]
            is_apart = channel.message_encoding == APART_ENCODING
            coded = topic is RGBD and not is_apart
            yield RecordedMessage(
                channel.topic,
                topic,
                parsed.name,
                message.data,
                message.log_time,
                message.publish_time,
                message.sequence,
                apart=is_apart,
                coded=chains.next_picture(channel.topic, message.data) if coded else None,
            )


def read_metadata(path: Path) -> dict[str, dict[str, str]]:
    """The named records about a whole recording; raises RecordingError."""
    with _open(path) as (_, reader):
        _summary(path, reader)
        with explaining_damage(path):
            return {
                record.name: record.metadata
                for record in reader.iter_metadata()
                if record.name != CHECKSUMS_RECORD
            }


@dataclass(frozen=True)
class Outline:
    """What a recording's index says: the number of messages of each key, when the first one was
    received, and when the last one was captured, in nanoseconds; None without any message."""

    counts: Mapping[str, int]
    received_ns: int | None
    last_captured_ns: int | None


def read_outline(path: Path, streams: Collection[str]) -> Outline:
    """The outline of streams of a whole recording, of which a few chunks are read at the most.

    Raises RecordingError and UnknownVersionError as ``read_recording`` does.
    """
    with _open(path) as (file, reader):
        summary = _summary(path, reader)
        chosen = choose_channels(summary.channels.values(), streams)
        counted = {} if summary.statistics is None else summary.statistics.channel_message_counts
        counts = dict.fromkeys(chosen, 0)
        for channel in summary.channels.values():
            if channel.topic in chosen and channel.message_encoding == MESSAGE_ENCODING:
                counts[channel.topic] += counted.get(channel.id, 0)
        with explaining_damage(path):
            times = CaptureTimes(file, summary, chosen)
            return Outline(counts, times.first_received(), times.last())


def choose_channels(
    channels: Iterable[Channel], streams: Collection[str] | None = None
) -> dict[str, tuple[AnyTopic, ParsedKey]]:
    """Choose the channels that hold messages of Inhand's streams, by key; raises
    UnknownVersionError."""
    chosen = {}
    for channel in channels:
        if channel.message_encoding != MESSAGE_ENCODING:
            continue
        try:
            topic, parsed = topic_of(channel.topic)
        except KeyFormatError as error:
            if isinstance(error, UnknownVersionError):
                raise
            continue
        if streams is None or topic.stream in streams:
            chosen[channel.topic] = topic, parsed
    return chosen


def apart_channels(
    channels: Iterable[Channel], streams: Collection[str] | None = None
) -> dict[str, tuple[AnyTopic, ParsedKey]]:
    """Choose the channels that hold what could not be read on its key, by key."""
    chosen = {}
    for channel in channels:
        if channel.message_encoding == APART_ENCODING:
            with suppress(KeyFormatError):  # no recorder of Inhand has written it
                topic, parsed = topic_of(channel.topic)
                if streams is None or topic.stream in streams:
                    chosen[channel.topic] = topic, parsed
    return chosen


def _records(
    path: Path, reader: SeekingReader, keys: Collection[str], encodings: Collection[str]
) -> Iterator[tuple[Channel, MessageRecord]]:
    ours = _is_ours(path, reader)
    records = (
        (message.log_time, (channel, message))
        for _, channel, message in reader.iter_messages(topics=keys, log_time_order=not ours)
        if channel.message_encoding in encodings
    )
    in_order = in_order_of_reception(records) if ours else (record for _, record in records)
    while True:
        with explaining_damage(path):
            record = next(in_order, None)
        if record is None:
            return
        yield record


def in_order_of_reception(timed: Iterable[tuple[int, Item]]) -> Iterator[Item]:
    """Sort what lies within a second of its time of reception, in nanoseconds; what lies farther
    back comes after a clock that was set."""
    waiting: list[tuple[int, int, Item]] = []
    newest_ns = 0
    for number, (time_ns, item) in enumerate(timed):
        if time_ns < newest_ns - REORDERED_NS:
            yield from (heapq.heappop(waiting)[2] for _ in range(len(waiting)))
            newest_ns = time_ns
        newest_ns = max(newest_ns, time_ns)
        heapq.heappush(waiting, (time_ns, number, item))
        while waiting[0][0] < newest_ns - REORDERED_NS:
            yield heapq.heappop(waiting)[2]
    yield from (heapq.heappop(waiting)[2] for _ in range(len(waiting)))


def _is_ours(path: Path, reader: SeekingReader) -> bool:
    with explaining_damage(path):
        return bool(reader.get_header().profile == PROFILE)


@contextmanager
def _open(path: Path) -> Iterator[tuple[IO[bytes], SeekingReader]]:
    with opening(path):
        file = path.open("rb")
    with file:
        _require_whole(path, file)
        yield file, SeekingReader(file, validate_crcs=True)


def _require_whole(path: Path, file: IO[bytes]) -> None:
    head = file.read(len(MCAP0_MAGIC))
    if not head:
        raise RecordingError(f"{path} is empty: nothing was recorded into it; delete it")
    if not MCAP0_MAGIC.startswith(head):
        raise RecordingError(f"{path} is no recording: give a .mcap file")
    size = file.seek(0, os.SEEK_END)
    file.seek(max(0, size - len(MCAP0_MAGIC)))
    if size < 2 * len(MCAP0_MAGIC) or file.read() != MCAP0_MAGIC:
        raise RecordingError(
            f"{path} was cut off: `inhand recording recover {path}` saves what is left"
        )
    file.seek(0)


def _summary(path: Path, reader: SeekingReader) -> Summary:
    with explaining_damage(path):
        summary = reader.get_summary()
    if summary is None:
        raise RecordingError(f"{path} has no index: `inhand recording recover {path}` writes one")
    return summary


@contextmanager
def explaining_damage(path: Path) -> Iterator[None]:
    """Raise RecordingError for damaged bytes that are read in a block, and for a failing disk."""
    try:
        yield
    except OSError as error:
        raise RecordingError(f"cannot read {path}: {error.strerror}") from error
    except DAMAGE as error:
        raise RecordingError(
            f"{path} is damaged ({error}): `inhand recording recover {path}` saves what is left"
        ) from error
