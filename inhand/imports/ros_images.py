"""Images and lenses of ROS messages, as those of Inhand."""

from typing import Any

import cv2
import numpy as np
import simplejpeg
from inhand_runtime.errors import InhandError
from inhand_runtime.pixels import encode_colour, encode_depth
from inhand_schemas.messages import CameraInfo, ColourImage, DepthImage
from numpy.typing import NDArray

DEPTH_SCALE = 0.001
"""Metres a unit of depth: the convention of ROS for 16 bits."""
_COLOURS = {
    "rgb8": (3, None),
    "bgr8": (3, cv2.COLOR_BGR2RGB),
    "rgba8": (4, cv2.COLOR_RGBA2RGB),
    "bgra8": (4, cv2.COLOR_BGRA2RGB),
    "mono8": (1, cv2.COLOR_GRAY2RGB),
    "yuv422": (2, cv2.COLOR_YUV2RGB_UYVY),
    "yuv422_yuy2": (2, cv2.COLOR_YUV2RGB_YUY2),
    "YUYV": (2, cv2.COLOR_YUV2RGB_YUY2),
}
"""Bytes of a pixel in an encoding, and what makes RGB of it; ``YUYV`` is RealSense's name."""
_DEPTHS = {"16UC1": "u2", "mono16": "u2", "32FC1": "f4"}
_COMPRESSED_DEPTH_HEAD = 12
"""Bytes before the PNG of a ``compressedDepth`` image."""


def is_depth(message: Any) -> bool:
    """Return whether an Image or a CompressedImage holds depth."""
    if hasattr(message, "encoding"):
        return message.encoding in _DEPTHS
    return "compressedDepth" in message.format or message.format.startswith("16UC1")


def colour_of(message: Any) -> ColourImage:
    """Return the colour of an Image or a CompressedImage; a JPEG stays as it is.

    Raises InhandError for an encoding that is not read, or damaged data.
    """
    if not hasattr(message, "encoding"):
        return _compressed_colour(message.data.tobytes(), message.format)
    if message.encoding not in _COLOURS:
        known = ", ".join(_COLOURS)
        raise InhandError(f"colour in {message.encoding!r} is not read, only {known}")
    channels, conversion = _COLOURS[message.encoding]
    pixels = _rows(message, np.dtype("u1"), channels)
    rgb = pixels if conversion is None else cv2.cvtColor(pixels, conversion)
    return encode_colour(np.ascontiguousarray(rgb, np.uint8))


def depth_of(message: Any) -> DepthImage:
    """Return the depth of an Image or a CompressedImage in units of ``DEPTH_SCALE``.

    Metres (``32FC1``) are rounded to a unit; what is no number, or farther than 65.5 m, was not
    measured. Raises InhandError as ``colour_of`` does.
    """
    if not hasattr(message, "encoding"):
        return encode_depth(_compressed_depth(message.data.tobytes(), message.format))
    if message.encoding not in _DEPTHS:
        raise InhandError(f"depth in {message.encoding!r} is not read, only {', '.join(_DEPTHS)}")
    kind = np.dtype(_DEPTHS[message.encoding])
    kind = kind.newbyteorder(">" if message.is_bigendian else "<")
    pixels = _rows(message, kind, 1)[..., 0]
    if kind.kind == "u":
        return encode_depth(pixels.astype(np.uint16))
    units = pixels / DEPTH_SCALE
    measured = np.isfinite(units) & (units > 0.0) & (units < np.iinfo(np.uint16).max)
    return encode_depth(np.where(measured, np.round(units), 0.0).astype(np.uint16))


def info_of(message: Any, time_ns: int, frame_rate: float) -> CameraInfo:
    """Return the lens of a CameraInfo, of ROS 1 or 2; raises InhandError for one that is none."""
    matrix = np.asarray(message.K if hasattr(message, "K") else message.k, float)
    distortion = np.asarray(message.D if hasattr(message, "D") else message.d, float)
    try:
        return CameraInfo(
            sequence=0,
            time_ns=time_ns,
            width=int(message.width),
            height=int(message.height),
            fx=float(matrix[0]),
            fy=float(matrix[4]),
            cx=float(matrix[2]),
            cy=float(matrix[5]),
            distortion=tuple(map(float, distortion)),
            depth_scale=DEPTH_SCALE,
            frame_rate=frame_rate,
            description=f"ROS, {message.header.frame_id}",
        )
    except ValueError as error:
        raise InhandError(f"the camera is not calibrated: {error}") from None


def _rows(message: Any, kind: "np.dtype[Any]", channels: int) -> NDArray[Any]:
    """Return the pixels (H, W, C) of rows that may be longer than the image is wide."""
    length = message.width * channels * kind.itemsize
    data = message.data.tobytes()
    if message.step < length or len(data) < message.step * message.height:
        raise InhandError(f"{len(data):,} bytes are too few for {message.width} × {message.height}")
    rows = np.frombuffer(data, np.uint8)[: message.step * message.height]
    packed = np.ascontiguousarray(rows.reshape(message.height, message.step)[:, :length])
    return packed.view(kind).reshape(message.height, message.width, channels)


def _compressed_colour(data: bytes, format_name: str) -> ColourImage:
    if simplejpeg.is_jpeg(data):
        try:
            height, width, *_ = simplejpeg.decode_jpeg_header(data)
        except ValueError as error:
            raise InhandError(f"damaged JPEG: {error}") from None
        return ColourImage("jpeg", width, height, data)
    pixels = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR) if data else None
    if pixels is None:
        raise InhandError(f"colour in {format_name!r} cannot be read")
    return encode_colour(np.ascontiguousarray(pixels[..., ::-1], np.uint8))


def _compressed_depth(data: bytes, format_name: str) -> NDArray[np.uint16]:
    start = data.find(b"\x89PNG", 0, _COMPRESSED_DEPTH_HEAD + 4)
    pixels = None
    if start >= 0:
        pixels = cv2.imdecode(np.frombuffer(data[start:], np.uint8), cv2.IMREAD_UNCHANGED)
    if pixels is None or pixels.dtype != np.uint16 or "32FC1" in format_name:
        raise InhandError(f"depth in {format_name!r} is not read, only 16UC1 as PNG")
    return np.asarray(pixels, np.uint16)
