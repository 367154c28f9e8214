"""depthai's frames as numbers, times and pixels."""

from dataclasses import dataclass
from datetime import timedelta
from typing import Any

import numpy as np
from inhand_runtime.source import Pixels, SourceError
from inhand_schemas.messages import CameraInfo, ColourImage
from numpy.typing import NDArray

from inhand_capture.sources.oak.library import dai
from inhand_capture.sources.oak.options import OakOptions

DEPTH_SCALE_M = 0.001
SHORTEST_LENS = 0.1
"""Focal length in image widths below which intrinsics are none: without, depthai says 1 pixel."""

Matrix = tuple[tuple[float, ...], ...]


@dataclass(frozen=True)
class Frame:
    """A frame of one stream: its number, and the middle of its exposure by both clocks, in
    nanoseconds, that of the device and the host's monotonic one."""

    number: int
    device_ns: int
    host_ns: int
    message: "dai.ImgFrame | dai.EncodedFrame"


def frame_of(message: "dai.ADatatype") -> Frame:
    """Wrap what a queue gave; depthai stamps the end of the exposure."""
    assert isinstance(message, dai.ImgFrame | dai.EncodedFrame)
    half = message.getExposureTime() / 2
    return Frame(
        number=message.getSequenceNum(),
        device_ns=_nanoseconds(message.getTimestampDevice() - half),
        host_ns=_nanoseconds(message.getTimestamp() - half),
        message=message,
    )


def pixels_of(colour: Frame, depth: Frame) -> Pixels:
    """Colour (H, W, 3) RGB, or as the device's JPEG, and depth (H, W) in millimetres."""
    return Pixels(_colour(colour.message), _depth(depth.message))


def camera_info(colour: Frame, depth: Frame, options: OakOptions, description: str) -> CameraInfo:
    """How the camera sees at the published size.

    Colour is undistorted, and depth aligned to it. Raises SourceError for frames that do not fit
    each other or the settings, and for intrinsics that are none.
    """
    width, height = options.pixels
    for what, frame in (("colour", colour), ("depth", depth)):
        size = (frame.message.getWidth(), frame.message.getHeight())
        if size != (width, height):
            raise SourceError(
                f"the camera sends {what} of {size[0]} × {size[1]} where {width} × {height} was "
                "asked for: choose another options.size"
            )
    lens: Any = colour.message.getTransformation()
    matrix: Matrix = lens.getIntrinsicMatrix()
    (fx, _, cx), (_, fy, cy) = matrix[0], matrix[1]
    if not min(fx, fy) >= SHORTEST_LENS * width:
        raise SourceError(
            f"the camera knows no intrinsics (it says a focal length of {fx:g} × {fy:g} pixels): "
            "it has lost its calibration; calibrate it again with its makers' tool"
        )
    return CameraInfo(
        sequence=0,
        time_ns=0,
        width=width,
        height=height,
        fx=fx,
        fy=fy,
        cx=cx,
        cy=cy,
        depth_scale=DEPTH_SCALE_M,
        frame_rate=options.frame_rate,
        description=description,
    )


def _colour(message: "dai.ImgFrame | dai.EncodedFrame") -> NDArray[np.uint8] | ColourImage:
    if isinstance(message, dai.EncodedFrame):
        data = message.getData().tobytes()
        return ColourImage("jpeg", message.getWidth(), message.getHeight(), data)
    colour: NDArray[np.uint8] = message.getFrame()
    return colour


def _depth(message: "dai.ImgFrame | dai.EncodedFrame") -> NDArray[np.uint16]:
    assert isinstance(message, dai.ImgFrame)
    depth: NDArray[np.uint16] = message.getFrame()
    return depth


def _nanoseconds(time: timedelta) -> int:
    return 1000 * round(time / timedelta(microseconds=1))
