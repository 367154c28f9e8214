"""Reads of a sample only what a recorder must know, so that megabytes of pixels stay unread."""

import msgspec
from inhand_runtime.inbox import Received
from inhand_schemas.errors import MessageError, UnknownVersionError
from inhand_schemas.messages import Message
from inhand_schemas.topics import topic_of

from inhand_recorder.recording_file import Entry

_decoder = msgspec.msgpack.Decoder(Message)


def entry_of(sample: Received) -> Entry:
    """The entry for a sample.

    Raises MessageError, KeyFormatError, or UnknownVersionError; what stands behind number and
    time is not looked at.
    """
    topic, _ = topic_of(sample.key)
    if sample.encoding != topic.encoding:
        raise UnknownVersionError(
            f"{topic.stream} comes as {sample.encoding!r}, and this release reads "
            f"{topic.encoding!r}: update the older side"
        )
    try:
        stamp = _decoder.decode(sample.payload)
    except (msgspec.MsgspecError, RecursionError) as error:
        raise MessageError(f"no valid {topic.message_type.__name__}: {error}") from None
    return Entry(
        key=sample.key,
        payload=sample.payload,
        received_ns=sample.received_ns,
        captured_ns=stamp.time_ns,
        sequence=stamp.sequence,
        kept=topic.delivery.kept,
    )
