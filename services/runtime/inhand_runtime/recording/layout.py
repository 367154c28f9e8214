"""What recordings are made of, for those who write them and those who read them."""

import struct
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from inhand_schemas.errors import MessageError
from inhand_schemas.messages import Message, RgbdFrame
from inhand_schemas.topics import AnyTopic
from mcap.exceptions import McapError
from msgspec.structs import replace
from zstandard import ZstdError

from inhand_runtime.errors import InhandError

if TYPE_CHECKING:
    from inhand_runtime.recording.coded_colour import CodedPicture

PROFILE = "inhand"
SCHEMA_ENCODING = "jsonschema"
MESSAGE_ENCODING = "msgpack"
APART_ENCODING = "x-undecodable"
"""The message encoding of a channel that holds what could not be read on its key."""
HEADER = struct.Struct("<BQ")
"""What each record begins with: its opcode, and the length of what follows."""
MESSAGE_HEAD = struct.Struct("<BQHIQQ")
"""A message's header, channel, number, and times of reception and of capture."""
CHUNK_BYTES = 1024 * 1024
MOST_CHANNELS = 0xFFFF
LATEST_NS = (1 << 64) - 1
SEQUENCE_MASK = 0xFFFFFFFF
REORDERED_NS = 1_000_000_000
"""Messages that were received this much apart, in nanoseconds, stand in order in a file of ours."""

DAMAGE = (
    McapError,
    ValueError,
    LookupError,
    ArithmeticError,
    MemoryError,
    RuntimeError,
    struct.error,
    ZstdError,
)
"""What the MCAP library raises on damaged bytes."""


class RecordingError(InhandError):
    """A recording that cannot be written or read; the message says the mend."""


@dataclass(frozen=True)
class RecordedMessage:
    """One message of a recording; times are nanoseconds since the epoch.

    ``sequence`` is the message's own, its lowest 32 bits. ``payload`` is what was recorded, in
    which ``coded`` is the colour where that is H.264. One that is ``apart`` could not be read on
    its key when it was recorded: it is there to be kept, and ``message`` raises.
    """

    key: str
    topic: AnyTopic
    name: str
    payload: bytes
    received_ns: int
    captured_ns: int
    sequence: int
    apart: bool = False
    coded: "CodedPicture | None" = field(default=None, compare=False, repr=False)

    def message(self) -> Message:
        """The payload decoded, with colour as the wire carries it: H.264 becomes ``rgb8``.

        Raises MessageError, and RecordingError where PyAV, which decodes H.264, is not installed.
        """
        message: Message = self.topic.decode(self.payload)
        return message if self.coded is None else replace(message, colour=self.coded.decoded())

    def frame(self) -> RgbdFrame:
        """The frame that this is, as ``message`` returns it; raises what that does."""
        message = self.message()
        if not isinstance(message, RgbdFrame):
            raise MessageError(f"{self.key} carries no frames")
        return message
