"""Whether a recording is whole, and all that it says is true."""

import zlib
from collections.abc import Iterator, Mapping
from pathlib import Path

from inhand_schemas.errors import KeyFormatError, MessageError
from inhand_schemas.topics import topic_of
from mcap.records import DataEnd, Message, Metadata, Statistics

from inhand_recorder.losses import LOSSES_RECORD, LossCounter, Losses, parse_losses
from inhand_recorder.scanning import (
    Bytes,
    Stretch,
    channels,
    is_complete,
    opened,
    scan,
)


def verify_recording(path: Path) -> list[str]:
    """All that is wrong with ``path``, a line each; empty when nothing is.

    Checked are the file's structure, index and checksums, every message against its type, times
    of reception, and the losses that the recorder wrote against the numbers in the file. Raises
    RecordingError for a file that is no recording.
    """
    with opened(path) as data:
        return list(_problems(path, data))


def _problems(path: Path, data: Bytes) -> Iterator[str]:
    if not is_complete(data):
        yield (
            "the end or the index is missing or damaged: "
            f"`inhand recording recover {path}` saves what is left"
        )
    messages = _Messages({number: channel.topic for number, channel in channels(data).items()})
    written: dict[str, str] = {}
    for stretch in scan(data):
        yield from _structural_problems(data, stretch)
        for record in stretch.records:
            if isinstance(record, Message):
                messages.check(record)
            elif isinstance(record, Metadata) and record.name == LOSSES_RECORD:
                written = record.metadata
            elif isinstance(record, Statistics) and record.message_count != messages.number:
                yield (
                    f"the index counts {record.message_count} messages, "
                    f"and {messages.number} can be read"
                )
    yield from messages.problems()
    if written:
        yield from _loss_problems(written, messages.counter.losses())


def _structural_problems(data: Bytes, stretch: Stretch) -> Iterator[str]:
    if stretch.unread_bytes:
        yield f"{stretch.unread_bytes} bytes from byte {stretch.offset} on are {stretch.state}"
    for record in stretch.records:
        if not isinstance(record, DataEnd) or record.data_section_crc == 0:
            continue
        if zlib.crc32(memoryview(data)[: stretch.offset]) != record.data_section_crc:
            yield "the checksum of the whole file does not fit: at least one byte was changed"


class _Messages:
    """Checks messages one by one and tells a key's faults in one line each."""

    def __init__(self, keys: Mapping[int, str]) -> None:
        self._keys = keys
        self._received_ns: dict[str, int] = {}
        self._backwards: dict[str, int] = {}
        self._malformed: dict[str, list[str]] = {}
        self.counter = LossCounter()
        self.number = 0

    def check(self, message: Message) -> None:
        self.number += 1
        key = self._keys.get(message.channel_id, f"channel {message.channel_id}")
        self.counter.count(key, message.sequence)
        if message.log_time < self._received_ns.get(key, 0):
            self._backwards[key] = self._backwards.get(key, 0) + 1
        self._received_ns[key] = message.log_time
        try:
            topic, _ = topic_of(key)
            topic.decode(message.data)
        except (KeyFormatError, MessageError) as error:
            self._malformed.setdefault(key, []).append(str(error))

    def problems(self) -> Iterator[str]:
        for key, errors in self._malformed.items():
            yield f"{key}: {len(errors)} messages cannot be decoded, the first: {errors[0]}"
        for key, times in self._backwards.items():
            yield f"{key}: the time of reception goes back {times} times"


def _loss_problems(written: Mapping[str, str], counted: Mapping[str, Losses]) -> Iterator[str]:
    try:
        told = parse_losses(written)
    except ValueError as error:
        yield str(error)
        return
    for key in sorted(told.keys() | counted.keys()):
        there, here = told.get(key, Losses()), counted.get(key, Losses())
        for what in ("received", "lost", "restarts"):
            said, found = getattr(there, what), getattr(here, what)
            if said != found:
                yield f"{key}: {what} is written as {said}, and the file shows {found}"
