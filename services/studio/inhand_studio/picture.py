"""One picture of a camera, decoded once for all who look at it."""

import threading

import numpy as np
from inhand_runtime.pixels import decode_colour, decode_metres
from inhand_schemas.messages import CameraInfo, ColourImage, Preview, RgbdFrame
from inhand_tracker.geometry.arrays import Bytes, Singles

FARTHEST_SHOWN_M = 5.0
"""Metres from which on depth, where it is all that a camera has, is drawn black."""


class Picture:
    """What a frame or a preview shows; thread-safe.

    It came at ``arrived``, in seconds of the clock that nobody sets.
    """

    def __init__(self, message: RgbdFrame | Preview, arrived: float) -> None:
        self.sequence, self.time_ns, self.arrived = message.sequence, message.time_ns, arrived
        self._message = message
        self._lock = threading.Lock()
        self._colour: Bytes | None = None

    @property
    def message(self) -> RgbdFrame | Preview:
        """The message that it came in."""
        return self._message

    def colour(self, info: CameraInfo) -> Bytes | None:
        """Return its pixels (H, W, 3) RGB: its colours, else its depth, near ones brighter.

        None where it has neither. Raises MessageError for damaged pixels.
        """
        with self._lock:
            if self._colour is None:
                self._colour = self._decoded()
            if self._colour is not None:
                return self._colour
        depth = self.depth(info)
        if depth is None:
            return None
        near = np.where(depth > 0.0, 1.0 - depth / FARTHEST_SHOWN_M, 0.0)
        grey = (255.0 * np.clip(near, 0.0, 1.0)).astype(np.uint8)
        return np.repeat(grey[..., None], 3, axis=2)

    def depth(self, info: CameraInfo) -> Singles | None:
        """Return its depth (H, W) in metres, 0 where none was measured; None without any.

        Raises MessageError for damaged pixels.
        """
        if isinstance(self._message, Preview) or self._message.depth is None:
            return None
        return decode_metres(self._message.depth, info.depth_scale)

    def _decoded(self) -> Bytes | None:
        message = self._message
        if isinstance(message, Preview):
            jpeg = ColourImage("jpeg", message.width, message.height, message.jpeg)
            return decode_colour(jpeg)
        return None if message.colour is None else decode_colour(message.colour)
