"""A whole recording from one that was cut off or damaged."""

from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from inhand_runtime.recording import (
    APART_ENCODING,
    MESSAGE_ENCODING,
    RecordingError,
    RecordingWriter,
)
from inhand_runtime.recording.checksums import CHECKSUMS_RECORD
from inhand_schemas.errors import KeyFormatError, MessageError, UnknownVersionError
from inhand_schemas.topics import AnyTopic, topic_of
from mcap.records import Attachment, Channel, Message, Metadata

from inhand_recorder.faults import (
    APART,
    FAULTS_FIELD,
    FOREIGN,
    RECOVERY_RECORD,
    UNCHECKED,
    UNDECODABLE,
    FaultLedger,
)
from inhand_recorder.losses import LOSSES_RECORD, LossCounter, format_losses, parse_losses
from inhand_recorder.records import Bytes, attachment_is_sound
from inhand_recorder.scanning import Stretch, channels, opened, scan

RECOVERING_SUFFIX = ".recovering"


@dataclass(frozen=True)
class RecoveryReport:
    """What was saved: ``messages`` messages of ``keys`` keys, and what was not.

    ``unchecked`` of them are covered by no checksum, and decode; ``undecodable`` messages were left
    out. ``skipped_bytes`` could not be read, or were no messages of Inhand's. ``faults`` names in
    lines each message that is damaged, cut off, left out or unchecked, as far as it can be named.
    """

    output: Path
    messages: int
    keys: int
    skipped_bytes: int
    unchecked: int = 0
    undecodable: int = 0
    faults: tuple[str, ...] = ()


def recover_recording(path: Path, output: Path) -> RecoveryReport:
    """Write all messages that are left in ``path`` to the new file ``output``.

    What a checksum contradicts is left out, and what does not decode. Named records and attachments
    stay,
    ``losses`` is counted anew, and ``recovery`` says where the file comes from. Raises
    RecordingError, also when nothing is left, and then leaves no file; neither the input nor an
    existing file is ever changed.
    """
    with opened(path) as data:
        unfinished = output.with_name(output.name + RECOVERING_SUFFIX)
        unfinished.unlink(missing_ok=True)
        try:
            with RecordingWriter(output, part_suffix=RECOVERING_SUFFIX) as writer:
                rescue = _rescue(path, data, writer)
        except RecordingError as error:
            if not isinstance(error.__cause__, OSError):
                raise
            raise RecordingError(
                f"cannot write {output}: {error.__cause__.strerror}: make room or use another "
                f"disk; {path} stays as it is"
            ) from error
        finally:
            unfinished.unlink(missing_ok=True)
    return RecoveryReport(
        output,
        rescue.messages,
        len(rescue.found),
        rescue.skipped_bytes,
        rescue.unchecked,
        rescue.undecodable,
        rescue.fault_lines(),
    )


def _rescue(path: Path, data: Bytes, writer: RecordingWriter) -> "_Rescue":
    rescue = _Rescue(writer, channels(data), path)
    for stretch in scan(data):
        rescue.take(stretch)
        for record in stretch.records:
            if isinstance(record, Attachment) and attachment_is_sound(data, stretch.offset):
                rescue.attach(record)
    if rescue.messages == 0:
        raise RecordingError(f"{path} holds no message of Inhand's that could be saved")
    rescue.finish(path)
    return rescue


class _Rescue:
    def __init__(self, writer: RecordingWriter, by_number: dict[int, Channel], path: Path) -> None:
        self._writer = writer
        self._known = _known(path, by_number)
        self._apart = {
            number
            for number, channel in by_number.items()
            if channel.message_encoding == APART_ENCODING
        }
        self.faults = FaultLedger({number: one.topic for number, one in by_number.items()})
        self._counter = LossCounter()
        self._dropped: dict[str, int] = {}
        self._unwritten: dict[str, int] = {}
        self.found: set[str] = set()
        self.messages = 0
        self.skipped_bytes = 0
        self.unchecked = 0
        self.undecodable = 0

    def take(self, stretch: Stretch) -> None:
        self.skipped_bytes += stretch.unread_bytes
        self.faults.take(stretch)
        for record in stretch.records:
            if isinstance(record, Message):
                self._take_message(record)
            elif isinstance(record, Metadata):
                self._take_metadata(record)
        for record in stretch.doubtful:
            if self._take_message(record):
                self.unchecked += 1
                self.faults.note(record, UNCHECKED)

    def attach(self, record: Attachment) -> None:
        self._writer.add_attachment(
            record.name, record.media_type, record.data, received_ns=record.log_time
        )

    def finish(self, source: Path) -> None:
        losses = self._counter.losses(self._dropped, self._unwritten)
        self._writer.add_metadata(LOSSES_RECORD, format_losses(losses))
        origin = {
            "source": source.name,
            "skipped_bytes": str(self.skipped_bytes),
            "unchecked": str(self.unchecked),
            "undecodable": str(self.undecodable),
            FAULTS_FIELD: "\n".join(self.fault_lines()),
        }
        self._writer.add_metadata(RECOVERY_RECORD, origin)

    def fault_lines(self) -> tuple[str, ...]:
        return tuple(self.faults.lines(kept=(UNCHECKED,)))

    def _take_message(self, record: Message) -> bool:
        """Whether the message was saved; what was not is named."""
        key, topic = self._known.get(record.channel_id, (None, None))
        if key is None or topic is None:
            self.faults.note(record, APART if record.channel_id in self._apart else FOREIGN)
            self.skipped_bytes += len(record.data)
            return False
        try:
            topic.check(record.data)
        except MessageError as error:
            self.faults.note(record, UNDECODABLE, str(error))
            self.undecodable += 1
            self.skipped_bytes += len(record.data)
            return False
        self._writer.write(
            key,
            record.data,
            received_ns=record.log_time,
            captured_ns=record.publish_time,
            sequence=record.sequence,
        )
        self._counter.count(key, record.sequence)
        self.found.add(key)
        self.messages += 1
        return True

    def _take_metadata(self, record: Metadata) -> None:
        if record.name == CHECKSUMS_RECORD:
            return
        if record.name != LOSSES_RECORD:
            self._writer.add_metadata(record.name, record.metadata)
            return
        with suppress(ValueError):
            written = parse_losses(record.metadata)
            self._dropped = {key: losses.dropped for key, losses in written.items()}
            self._unwritten = {key: losses.unwritten for key, losses in written.items()}


def _known(path: Path, by_number: dict[int, Channel]) -> dict[int, tuple[str, AnyTopic]]:
    known = {}
    for number, channel in by_number.items():
        if channel.message_encoding != MESSAGE_ENCODING:
            continue
        try:
            topic, _ = topic_of(channel.topic)
        except UnknownVersionError as error:
            raise RecordingError(f"{path}: {error}") from None
        except KeyFormatError:
            continue
        known[number] = channel.topic, topic
    return known
