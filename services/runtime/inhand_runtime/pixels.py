"""Pixels to bytes and back, in the codecs that messages name."""

import numpy as np
import simplejpeg
import zstandard
from inhand_schemas.errors import MessageError
from inhand_schemas.fields import DepthCodec
from inhand_schemas.messages import ColourImage, DepthImage
from numpy.typing import NDArray

from inhand_runtime.png_depth import decode_png, encode_png
from inhand_runtime.wording import counted

JPEG_QUALITY = 90
ZSTD_LEVEL = 1
LUMINANCE_OF_RGB = np.array((0.299, 0.587, 0.114))


def encode_colour(colour: NDArray[np.uint8]) -> ColourImage:
    """(H, W, 3) RGB as JPEG."""
    height, width = colour.shape[:2]
    data = simplejpeg.encode_jpeg(np.ascontiguousarray(colour), JPEG_QUALITY, "RGB", "420")
    return ColourImage("jpeg", width, height, data)


def decode_colour(image: ColourImage) -> NDArray[np.uint8]:
    """(H, W, 3) RGB; raises MessageError when the bytes are damaged."""
    if image.codec == "rgb8":
        return np.frombuffer(image.data, np.uint8).reshape(image.height, image.width, 3)
    return _decode_jpeg(image, "RGB")


def raw_colour(colour: NDArray[np.uint8] | ColourImage | None) -> NDArray[np.uint8] | None:
    """(H, W, 3) RGB of what may be encoded already; raises MessageError when damaged."""
    return decode_colour(colour) if isinstance(colour, ColourImage) else colour


def raw_depth(depth: NDArray[np.uint16] | DepthImage | None) -> NDArray[np.uint16] | None:
    """(H, W) depth units of what may be encoded already; raises MessageError when damaged."""
    return decode_depth(depth) if isinstance(depth, DepthImage) else depth


def decode_grey(image: ColourImage) -> NDArray[np.uint8]:
    """(H, W) luminance, cheaper than all of the colour; raises MessageError when damaged."""
    if image.codec == "rgb8":
        luminance: NDArray[np.float64] = decode_colour(image) @ LUMINANCE_OF_RGB
        return luminance.astype(np.uint8)
    grey: NDArray[np.uint8] = _decode_jpeg(image, "GRAY")[..., 0]
    return grey


def encode_depth(depth: NDArray[np.uint16], codec: DepthCodec = "z16-zstd") -> DepthImage:
    """(H, W) depth units, without loss."""
    height, width = depth.shape
    if codec == "png16":
        return DepthImage(codec, width, height, encode_png(depth))
    if codec == "z16":
        return DepthImage(codec, width, height, depth.astype("<u2").tobytes())
    data = zstandard.ZstdCompressor(level=ZSTD_LEVEL).compress(depth.astype("<u2").tobytes())
    return DepthImage("z16-zstd", width, height, data)


def decode_depth(image: DepthImage) -> NDArray[np.uint16]:
    """(H, W) depth units; raises MessageError when the bytes are damaged."""
    return _depth_units(image).astype(np.uint16)


def decode_metres(image: DepthImage, unit_m: float) -> NDArray[np.float32]:
    """(H, W) depth in metres by the metres in a unit; raises MessageError when the bytes are
    damaged."""
    return np.multiply(_depth_units(image), np.float32(unit_m), dtype=np.float32)


def _depth_units(image: DepthImage) -> NDArray[np.uint16]:
    """(H, W) depth units, which cannot be written; raises MessageError when the bytes are
    damaged."""
    if image.codec == "png16":
        return decode_png(image.data, image.width, image.height)
    size = 2 * image.width * image.height
    data = image.data
    if image.codec == "z16-zstd":
        try:
            if zstandard.frame_content_size(data) > size:
                raise MessageError("damaged depth: it is larger than the image")
            data = zstandard.ZstdDecompressor().decompress(data, max_output_size=size)
        except zstandard.ZstdError as error:
            raise MessageError(f"damaged depth: {error}") from None
    if len(data) != size:
        raise MessageError(
            f"damaged depth: {counted(len(data), 'byte')}, where the image takes {size:,}"
        )
    return np.frombuffer(data, "<u2").reshape(image.height, image.width)


def _decode_jpeg(image: ColourImage, colour_space: str) -> NDArray[np.uint8]:
    if image.codec != "jpeg":
        raise MessageError(f"colour as {image.codec} is read from recordings alone")
    try:
        height, width, *_ = simplejpeg.decode_jpeg_header(image.data)
        fits = (height, width) == (image.height, image.width)
        pixels = simplejpeg.decode_jpeg(image.data, colour_space) if fits else None
    except ValueError as error:
        raise MessageError(f"damaged JPEG: {error}") from None
    if pixels is None:
        raise MessageError(
            f"damaged JPEG: it is {width} × {height}, "
            f"and the message says {image.width} × {image.height}"
        )
    return np.asarray(pixels, np.uint8)
