"""What a recorded message says, in a few bytes: two files may hold copies of it."""

from hashlib import blake2b

from inhand_runtime.recording import RecordedMessage
from inhand_schemas.errors import MessageError
from inhand_schemas.topics import RGBD

DIGEST_BYTES = 8


def content_digest(message: RecordedMessage) -> bytes:
    """Return a digest that copies of a message have in common.

    It is of the payload; of a frame of its depth alone, since each recorder codes colour for
    itself: frames without depth are all alike.
    """
    return blake2b(_content(message), digest_size=DIGEST_BYTES).digest()


def _content(message: RecordedMessage) -> bytes:
    if message.topic is not RGBD or message.apart:
        return message.payload
    try:
        depth = RGBD.decode(message.payload).depth
    except MessageError:
        return message.payload
    return b"" if depth is None else depth.data
