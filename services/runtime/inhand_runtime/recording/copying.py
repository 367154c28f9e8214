"""Copies of recordings to which something is added; what is copied is never changed."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from inhand_schemas.errors import MessageError
from inhand_schemas.topics import RGBD
from msgspec import structs

from inhand_runtime.pixels import decode_colour, encode_colour
from inhand_runtime.recording.coded_colour import CodedPicture
from inhand_runtime.recording.layout import RecordedMessage
from inhand_runtime.recording.part_file import PART_SUFFIX
from inhand_runtime.recording.reading import read_metadata
from inhand_runtime.recording.writing import RecordingWriter


@contextmanager
def written_or_gone(output: Path) -> Iterator[RecordingWriter]:
    """Write a new recording in a block; where that fails or is interrupted, nothing of it stays.

    Raises RecordingError where there is a file of that name, or one that grows into it.
    """
    opened = RecordingWriter(output)
    try:
        with opened as writer:
            yield writer
    except BaseException:
        output.with_name(output.name + PART_SUFFIX).unlink(missing_ok=True)
        raise


def write_beside(writer: RecordingWriter, key: str, of: RecordedMessage, payload: bytes) -> None:
    """Write a message with the times and the number of another one, which it is of."""
    writer.write(
        key,
        payload,
        received_ns=of.received_ns,
        captured_ns=of.captured_ns,
        sequence=of.sequence,
    )


class StandingAlone:
    """Keeps what is written to a new file readable by itself, of messages that are some of another
    one's: colour as H.264 stays so where what it builds on was written too, and is JPEG else."""

    def __init__(self) -> None:
        self._written: dict[str, int] = {}

    def standing(self, message: RecordedMessage) -> RecordedMessage:
        """Return what is written next for a message.

        One that cannot be decoded stays as it is. Raises RecordingError where PyAV is missing.
        """
        if message.coded is None or self.stands(message.key, message.coded):
            return message
        try:
            return as_jpeg(message)
        except MessageError:
            return message

    def stands(self, key: str, coded: CodedPicture) -> bool:
        """Whether what a picture builds on was written before it; if so, it is written next."""
        stands = coded.image.builds_on in (None, self._written.get(key))
        if stands:
            self._written[key] = coded.digest
        return stands


def as_jpeg(message: RecordedMessage) -> RecordedMessage:
    """Return a message whose colour as H.264 is JPEG; raises MessageError and RecordingError."""
    frame = message.frame()
    if message.coded is None or frame.colour is None:
        return message
    frame = structs.replace(frame, colour=encode_colour(decode_colour(frame.colour)))
    return replace(message, payload=RGBD.encode(frame), coded=None)


def copy_message(writer: RecordingWriter, message: RecordedMessage) -> None:
    """Write a message as it was recorded, one that is apart as such."""
    if message.apart:
        writer.write_apart(message.key, message.payload, received_ns=message.received_ns)
        return
    write_beside(writer, message.key, message, message.payload)


def copy_metadata(
    writer: RecordingWriter, path: Path, name: str, values: Mapping[str, str]
) -> None:
    """Copy the records about a recording, and add one of that name on what the copy is.

    Raises RecordingError.
    """
    for kept, record in read_metadata(path).items():
        writer.add_metadata(kept, record)
    writer.add_metadata(name, values)
