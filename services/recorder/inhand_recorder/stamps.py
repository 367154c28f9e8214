"""Makes a sample into an entry of a recording."""

from inhand_runtime.inbox import Received
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import RgbdFrame
from inhand_schemas.topics import topic_of

from inhand_recorder.recording_file import Entry


def entry_of(sample: Received) -> Entry:
    """The entry for a sample that can be read.

    Raises MessageError, KeyFormatError, or UnknownVersionError. All of a message is decoded: one
    that cannot be read would spoil its recording for whoever replays or trains from it.
    """
    topic, _ = topic_of(sample.key)
    message = topic.check(sample.payload, sample.encoding)
    if isinstance(message, RgbdFrame) and message.colour and message.colour.codec == "h264":
        raise MessageError("its colour is H.264, which is not for the wire")
    return Entry(
        key=sample.key,
        payload=sample.payload,
        received_ns=sample.received_ns,
        captured_ns=message.time_ns,
        sequence=message.sequence,
        kept=topic.delivery.kept,
    )


def entry_apart(sample: Received) -> Entry:
    """The entry that keeps an unreadable sample apart, under a key that must be Inhand's."""
    return Entry(
        key=sample.key,
        payload=sample.payload,
        received_ns=sample.received_ns,
        captured_ns=sample.received_ns,
        sequence=0,
        apart=True,
    )
