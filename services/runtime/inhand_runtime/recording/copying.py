"""Copies of recordings to which something is added; what is copied is never changed."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

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
