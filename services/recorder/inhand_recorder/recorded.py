"""One message of a recording, decoded, and the images of a frame as arrays."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from inhand_runtime.pixels import decode_colour, decode_depth
from inhand_runtime.recording import RecordedMessage
from inhand_runtime.recording.coded_colour import CodedPicture
from inhand_schemas.messages import CameraInfo, Message, RgbdFrame
from numpy.typing import NDArray


@dataclass(frozen=True)
class Recorded:
    """One message with its whole ``key``, its ``topic`` (``pose/mug``), and the time at which the
    recorder received it, in nanoseconds since the epoch."""

    key: str
    topic: str
    received_ns: int
    message: Message

    @property
    def name(self) -> str:
        """The last part of the key: of the camera, the object, the kind or the instance."""
        return self.key.rpartition("/")[2]

    @property
    def time_ns(self) -> int:
        """When it was captured, in nanoseconds since the epoch; what is of one frame has its."""
        return self.message.time_ns

    @property
    def sequence(self) -> int:
        """Its number; what is of one frame has the frame's."""
        return self.message.sequence


@dataclass(frozen=True)
class RecordedImages(Recorded):
    """One frame of a camera; images are decoded when they are first asked for.

    ``info`` describes the camera; None where the recording has no info of it. ``coded`` is the
    colour as it was recorded, where that is H.264; in ``message`` it is ``rgb8``.
    """

    message: RgbdFrame
    info: CameraInfo | None
    coded: CodedPicture | None = None

    @cached_property
    def colour(self) -> NDArray[np.uint8] | None:
        """RGB (H, W, 3); None where the frame has none. Raises MessageError where damaged."""
        image = self.message.colour
        return None if image is None else decode_colour(image)

    @cached_property
    def depth(self) -> NDArray[np.uint16] | None:
        """Depth (H, W) in units of ``info.depth_scale`` metres, 0 where nothing was measured; None
        where the frame has none. Raises MessageError where damaged."""
        image = self.message.depth
        return None if image is None else decode_depth(image)

    @property
    def depth_m(self) -> NDArray[np.float32] | None:
        """Depth (H, W) along the optical axis in metres, 0 where nothing was measured.

        Raises ValueError where the recording does not say the camera's scale.
        """
        if self.depth is None:
            return None
        if self.info is None:
            raise ValueError(
                f"there is no info of {self.name}, which says the scale of its depth: `inhand "
                "recording repair` adds it"
            )
        return self.depth.astype(np.float32) * np.float32(self.info.depth_scale)


def decoded(recorded: RecordedMessage, topic: str, info: CameraInfo | None) -> Recorded:
    """Decode a message; raises MessageError."""
    message = recorded.message()
    if isinstance(message, RgbdFrame):
        whose = recorded.key, topic, recorded.received_ns
        return RecordedImages(*whose, message, info, recorded.coded)
    return Recorded(recorded.key, topic, recorded.received_ns, message)
