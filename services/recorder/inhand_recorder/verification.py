"""Whether a recording is whole, and all that it says is true."""

import zlib
from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from inhand_runtime.recording import APART_ENCODING
from inhand_runtime.recording.coded_colour import coded_image, digest_of
from inhand_runtime.wording import counted
from inhand_schemas.errors import KeyFormatError, MessageError
from inhand_schemas.keys import parse_key
from inhand_schemas.topics import INFO, RGBD, topic_of
from mcap.records import Attachment, DataEnd, Message, Metadata, Statistics

from inhand_recorder.clock import CLOCK_RECORD, parse_clock_steps, time_text
from inhand_recorder.faults import (
    FAULTS_FIELD,
    RECOVERY_RECORD,
    UNCHECKED,
    UNDECODABLE,
    FaultLedger,
)
from inhand_recorder.losses import LOSSES_RECORD, LossCounter, Losses, parse_losses
from inhand_recorder.records import Bytes, attachment_is_sound
from inhand_recorder.redaction import redaction_lines
from inhand_recorder.scanning import (
    Stretch,
    channels,
    has_checksums,
    is_complete,
    opened,
    scan,
)

FEWEST_TIMED = 10
"""Number of messages from which on their rate is judged."""
MOST_PLAUSIBLE_HZ = 10_000.0


@dataclass(frozen=True)
class Examination:
    """What is wrong with a recording, and what is only worth to know, a line each."""

    problems: tuple[str, ...]
    notes: tuple[str, ...]


def verify_recording(path: Path) -> list[str]:
    """All that is wrong with ``path``, a line each; empty when nothing is.

    Checked are the file's structure, index and checksums, every message against its type, times
    of reception, that frames come with their camera's info, and the losses that the recorder wrote
    against the numbers in the file. Raises RecordingError for a file that is no recording.
    """
    return list(examine_recording(path).problems)


def examine_recording(path: Path) -> Examination:
    """What ``verify_recording`` finds, and notes beside it; raises RecordingError."""
    with opened(path) as data:
        known = channels(data)
        messages = _Messages({number: one.topic for number, one in known.items()})
        apart = {
            number
            for number, channel in known.items()
            if channel.message_encoding == APART_ENCODING
        }
        problems = list(_problems(path, data, messages, apart))
        notes = list(messages.notes())
        if is_complete(data) and not has_checksums(data):
            notes.append("the file has no checksums: a changed byte cannot be seen")
    return Examination(tuple(problems), tuple(notes))


def _problems(path: Path, data: Bytes, messages: "_Messages", apart: set[int]) -> Iterator[str]:
    if not is_complete(data):
        yield (
            "the end or the index is missing or damaged: "
            f"`inhand recording recover {path}` saves what is left"
        )
    written: dict[str, str] = {}
    for stretch in scan(data):
        messages.faults.take(stretch)
        yield from _structural_problems(data, stretch)
        for record in stretch.records:
            if isinstance(record, Message):
                messages.check(record, apart=record.channel_id in apart)
            elif isinstance(record, Metadata) and record.name == LOSSES_RECORD:
                written = record.metadata
            elif isinstance(record, Metadata) and record.name == CLOCK_RECORD:
                messages.clock_steps = parse_clock_steps(record.metadata)
            elif isinstance(record, Metadata) and record.name == RECOVERY_RECORD:
                messages.recovery = record.metadata
            elif isinstance(record, Metadata):
                messages.redactions.extend(redaction_lines({record.name: record.metadata}))
            elif isinstance(record, Statistics) and record.message_count != messages.number:
                yield (
                    f"the index counts {counted(record.message_count, 'message')}, "
                    f"and {messages.number:,} can be read"
                )
        for record in stretch.doubtful:
            messages.faults.note(record, UNCHECKED)
    yield from messages.faults.lines()
    yield from messages.problems()
    yield from messages.missing_infos(path)
    if written:
        yield from _loss_problems(written, messages.counter.losses())


def _structural_problems(data: Bytes, stretch: Stretch) -> Iterator[str]:
    for record in stretch.records:
        if isinstance(record, Attachment) and not attachment_is_sound(data, stretch.offset):
            yield f"the attachment {record.name} is damaged, its checksum contradicts it"
        if not isinstance(record, DataEnd) or record.data_section_crc == 0:
            continue
        if zlib.crc32(memoryview(data)[: stretch.offset]) != record.data_section_crc:
            yield "the checksum of the whole file does not fit: at least one byte was changed"


class _Messages:
    """Checks messages one by one and names a key's faults in one line each."""

    def __init__(self, keys: Mapping[int, str]) -> None:
        self._keys = keys
        self._received_ns: dict[str, int] = {}
        self._backwards: dict[str, int] = {}
        self._apart: Counter[str] = Counter()
        self._pictures: dict[str, int] = {}
        self._baseless: Counter[str] = Counter()
        self._counts: Counter[str] = Counter()
        self._first_ns: dict[str, int] = {}
        self._last_ns: dict[str, int] = {}
        self.clock_steps: dict[int, int] = {}
        self.recovery: dict[str, str] = {}
        self.redactions: list[str] = []
        self.counter = LossCounter()
        self.faults = FaultLedger(keys)
        self.number = 0

    def check(self, message: Message, *, apart: bool) -> None:
        self.number += 1
        key = self._keys.get(message.channel_id, f"channel {message.channel_id}")
        if apart:
            self._apart[key] += 1
            return
        self.counter.count(key, message.sequence)
        self._counts[key] += 1
        self._first_ns.setdefault(key, message.publish_time)
        self._last_ns[key] = message.publish_time
        if message.log_time < self._received_ns.get(key, 0):
            self._backwards[key] = self._backwards.get(key, 0) + 1
        self._received_ns[key] = message.log_time
        try:
            topic, _ = topic_of(key)
            topic.check(message.data)
            if topic is RGBD:
                self._note_colour(key, message.data)
        except (KeyFormatError, MessageError) as error:
            self.faults.note(message, UNDECODABLE, str(error))

    def _note_colour(self, key: str, payload: bytes) -> None:
        image = coded_image(payload)
        if image is None:
            return
        if image.builds_on in (None, self._pictures.get(key)):
            self._pictures[key] = digest_of(image)
        else:
            self._baseless[key] += 1

    def problems(self) -> Iterator[str]:
        for key, count in self._baseless.items():
            yield (
                f"{key}: the colour of {counted(count, 'frame')} cannot be read, since pictures "
                "that it builds on (H.264) are not in the file"
            )
        steps_back = sum(step_ns < 0 for step_ns in self.clock_steps.values())
        for key, times in self._backwards.items():
            if times > steps_back:
                yield f"{key}: the time of reception goes back {counted(times, 'time')}"
        for key, count in self._counts.items():
            seconds = (self._last_ns[key] - self._first_ns[key]) / 1e9
            if count >= FEWEST_TIMED and not seconds < 0 and count > MOST_PLAUSIBLE_HZ * seconds:
                yield (
                    f"{key}: {counted(count, 'message')} captured in {seconds:g} s: the times are "
                    "in another unit than nanoseconds, or all the same"
                )

    def missing_infos(self, path: Path) -> Iterator[str]:
        by_stream: dict[str, set[str]] = {RGBD.stream: set(), INFO.stream: set()}
        for key in self._counts:
            with suppress(KeyFormatError):
                parsed = parse_key(key)
                by_stream.setdefault(parsed.stream, set()).add(parsed.name)
        for name in sorted(by_stream[RGBD.stream] - by_stream[INFO.stream]):
            yield (
                f"the frames of {name} have no camera info: nothing can be seen in them; "
                f"`inhand recording repair {path} --info FILE` takes it from another recording"
            )

    def notes(self) -> Iterator[str]:
        for at_ns, step_ns in sorted(self.clock_steps.items()):
            yield f"the clock was set by {step_ns / 1e9:+.3f} s at {time_text(at_ns)}"
        for line in self.recovery.get(FAULTS_FIELD, "").splitlines():
            yield f"recovered from {self.recovery.get('source', 'another file')}: {line}"
        yield from self.redactions
        for key, count in self._apart.items():
            yield f"{key}: kept apart, as undecodable: {counted(count, 'message')}"


def _loss_problems(written: Mapping[str, str], counted: Mapping[str, Losses]) -> Iterator[str]:
    """Compare what a recorder wrote with the file; of keys that a copy has beyond the recorder's,
    as skeletons, labels and poses made later, it says nothing."""
    try:
        claimed = parse_losses(written)
    except ValueError as error:
        yield str(error)
        return
    for key, there in sorted(claimed.items()):
        here = counted.get(key, Losses())
        for what in ("received", "lost", "restarts"):
            said, found = getattr(there, what), getattr(here, what)
            if said != found:
                yield f"{key}: {what} is written as {said}, and the file shows {found}"
