"""A source's moments as messages on a camera's topics, as far as somebody listens."""

import time
from typing import Protocol, TypeVar

import numpy as np
from inhand_runtime.pixels import decode_depth, encode_colour, encode_depth
from inhand_runtime.source import Captured, Pixels
from inhand_schemas.errors import MessageError
from inhand_schemas.fields import DepthCodec
from inhand_schemas.messages import (
    CameraInfo,
    ColourImage,
    DepthImage,
    Message,
    ObjectPose,
    RgbdFrame,
    Skeletons,
)
from inhand_schemas.topics import INFO, LABEL, RGBD, SKELETONS, Topic
from msgspec.structs import replace
from numpy.typing import NDArray

T = TypeVar("T", bound=Message)
T_contra = TypeVar("T_contra", bound=Message, contravariant=True)


class Outlet(Protocol[T_contra]):
    """Where one topic's messages go."""

    def put(self, message: T_contra) -> None:
        """Send a message."""

    def wanted(self) -> bool:
        """Whether anybody listens now."""


class Outlets(Protocol):
    """What makes outlets, such as a daemon."""

    def publisher(self, topic: Topic[T], name: str) -> Outlet[T]:
        """The outlet of a topic under one name."""


class CameraPublisher:
    """Publishes what one camera captures; what belongs together shares its sequence number."""

    def __init__(self, outlets: Outlets, camera: str, depth_codec: DepthCodec = "z16-zstd") -> None:
        """``depth_codec`` is how raw depth is encoded, and, where it is "png16", all depth."""
        self._depth_codec = depth_codec
        self._outlets = outlets
        self._camera = camera
        self._info = outlets.publisher(INFO, camera)
        self._skeletons = outlets.publisher(SKELETONS, camera)
        self._rgbd = outlets.publisher(RGBD, camera)
        self._labels: dict[str, Outlet[ObjectPose]] = {}
        self._introductions = 0
        self._sequence = 0

    def introduce(self, info: CameraInfo) -> None:
        """Publish how the camera sees, to all who listen and will listen."""
        time_ns = info.time_ns or time.time_ns()
        self._info.put(replace(info, sequence=self._introductions, time_ns=time_ns))
        self._introductions += 1

    def has_readers(self) -> bool:
        """Whether anybody listens to skeletons or pictures now."""
        return self._skeletons.wanted() or self._rgbd.wanted()

    def wants_pixels(self) -> bool:
        """Whether anybody listens to pictures now."""
        return self._rgbd.wanted()

    def wants_skeletons(self) -> bool:
        """Whether anybody listens to skeletons now."""
        return self._skeletons.wanted()

    def publish(self, captured: Captured) -> int:
        """Send one moment, the small messages first, so that pixels never hold them up; return its
        sequence number."""
        sequence = self._sequence
        self._sequence += 1
        if captured.people is not None and self._skeletons.wanted():
            self._skeletons.put(
                Skeletons(
                    sequence=sequence,
                    time_ns=captured.time_ns,
                    people=captured.people,
                    convention=captured.convention,
                )
            )
        for label in captured.labels:
            self._publish_label(label, sequence, captured.time_ns)
        if captured.pixels is not None and self._rgbd.wanted():
            self._rgbd.put(self._rgbd_frame(captured, captured.pixels(), sequence))
        return sequence

    def _publish_label(self, label: ObjectPose, sequence: int, time_ns: int) -> None:
        if label.object not in self._labels:
            self._labels[label.object] = self._outlets.publisher(LABEL, label.object)
        outlet = self._labels[label.object]
        if outlet.wanted():
            outlet.put(replace(label, sequence=sequence, time_ns=time_ns, camera=self._camera))

    def _rgbd_frame(self, captured: Captured, pixels: Pixels, sequence: int) -> RgbdFrame:
        colour = pixels.colour
        if colour is not None and not isinstance(colour, ColourImage):
            colour = encode_colour(colour)
        return RgbdFrame(
            sequence=sequence,
            time_ns=captured.time_ns,
            time_uncertainty_ns=captured.time_uncertainty_ns,
            colour=colour,
            depth=None if pixels.depth is None else encoded_depth(pixels.depth, self._depth_codec),
        )


def encoded_depth(depth: NDArray[np.uint16] | DepthImage, codec: DepthCodec) -> DepthImage:
    """Encode depth. What is encoded already passes as it is, unless PNG is asked for.

    So does what is damaged: its readers refuse and count it, as without this.
    """
    if not isinstance(depth, DepthImage):
        return encode_depth(depth, codec)
    if codec != "png16" or depth.codec == codec:
        return depth
    try:
        return encode_depth(decode_depth(depth), codec)
    except MessageError:
        return depth
