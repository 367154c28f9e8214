"""Depth as PNG of 16 bits, which any program reads."""

import struct
import zlib
from collections.abc import Iterator

import numpy as np
from inhand_schemas.errors import MessageError
from numpy.typing import NDArray

SIGNATURE = b"\x89PNG\r\n\x1a\n"
HEADER = struct.Struct(">IIBBBBB")
"""Of IHDR: width, height, bits, kind of colour, compression, filters, interlacing."""
GREY_16 = (16, 0)
COMPRESSION = 1
"""Level of zlib: with runs alone it is as small as level 3 and takes half as long."""


def encode_png(depth: NDArray[np.uint16]) -> bytes:
    """(H, W) depth units as PNG, without loss."""
    import cv2

    runs = (cv2.IMWRITE_PNG_STRATEGY, cv2.IMWRITE_PNG_STRATEGY_RLE)
    settings = (cv2.IMWRITE_PNG_COMPRESSION, COMPRESSION, *runs)
    done, data = cv2.imencode(".png", depth, settings)
    if not done:
        raise ValueError(f"no PNG can be made of depth {depth.shape} of {depth.dtype}")
    return data.tobytes()


def decode_png(data: bytes, width: int, height: int) -> NDArray[np.uint16]:
    """(H, W) depth units; raises MessageError where it is damaged, or another picture.

    All that can be known is checked before it is decoded: a picture may say that it is so large
    that no memory holds it, and what decodes PNG writes its complaints to standard error.
    """
    import cv2

    chunks = dict(_chunks(data))
    wide, high, *kind = HEADER.unpack(chunks[b"IHDR"])
    if (wide, high) != (width, height):
        raise MessageError(
            f"damaged PNG: it is {wide} × {high}, and the message says {width} × {height}"
        )
    if tuple(kind[:2]) != GREY_16:
        raise MessageError("damaged PNG: depth is one channel of 16 bits")
    if b"IEND" not in chunks:
        raise MessageError("damaged PNG: it was cut off")
    depth = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED)
    if depth is None or depth.dtype != np.uint16 or depth.shape != (height, width):
        raise MessageError("damaged PNG: it cannot be decoded")
    return np.asarray(depth, np.uint16)


def _chunks(data: bytes) -> Iterator[tuple[bytes, bytes]]:
    """Give the names and bodies of the chunks; the first is the header.

    Raises MessageError for what is no PNG, and for a chunk whose checksum is wrong.
    """
    beginning = SIGNATURE + struct.pack(">I", HEADER.size) + b"IHDR"
    if not data.startswith(beginning) or len(data) < len(beginning) + HEADER.size + 4:
        raise MessageError("damaged PNG: it does not begin as one")
    place = len(SIGNATURE)
    while place + 12 <= len(data):
        (length,) = struct.unpack_from(">I", data, place)
        end = place + 8 + length
        if end + 4 > len(data):
            raise MessageError("damaged PNG: it was cut off")
        if zlib.crc32(data[place + 4 : end]) != struct.unpack_from(">I", data, end)[0]:
            raise MessageError("damaged PNG: a checksum is wrong")
        yield data[place + 4 : place + 8], data[place + 8 : end]
        place = end + 4
