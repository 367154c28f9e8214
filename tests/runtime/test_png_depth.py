"""Depth as PNG, for programs of others: what they write, and what is damaged."""

import struct
import zlib

import cv2
import numpy as np
import pytest
from inhand_runtime.pixels import decode_depth
from inhand_runtime.png_depth import decode_png, encode_png
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import DepthImage
from numpy.typing import NDArray

DEPTH = np.arange(48 * 64, dtype=np.uint16).reshape(48, 64) * 21
GOOD = encode_png(DEPTH)


def _chunk(name: bytes, body: bytes) -> bytes:
    checksum = struct.pack(">I", zlib.crc32(name + body))
    return struct.pack(">I", len(body)) + name + body + checksum


def _png(header: bytes, rows: bytes, *more: bytes) -> bytes:
    """A PNG made by hand, as another program would."""
    parts = (_chunk(b"IHDR", header), *more, _chunk(b"IDAT", zlib.compress(rows)))
    return b"\x89PNG\r\n\x1a\n" + b"".join(parts) + _chunk(b"IEND", b"")


def _header(width: int, height: int, bits: int = 16, kind: int = 0) -> bytes:
    return struct.pack(">IIBBBBB", width, height, bits, kind, 0, 0, 0)


def test_any_program_reads_what_we_write() -> None:
    read = cv2.imdecode(np.frombuffer(GOOD, np.uint8), cv2.IMREAD_UNCHANGED)
    np.testing.assert_array_equal(np.asarray(read), DEPTH)


def test_the_most_significant_byte_is_first_in_a_file() -> None:
    rows = b"\x00" + struct.pack(">3H", 1, 256, 65535)
    np.testing.assert_array_equal(decode_png(_png(_header(3, 1), rows), 3, 1), [[1, 256, 65535]])


def test_chunks_that_others_add_do_not_matter() -> None:
    rows = b"".join(b"\x00" + row.astype(">u2").tobytes() for row in DEPTH)
    data = _png(_header(64, 48), rows, _chunk(b"tEXt", b"Author\x00somebody"))
    np.testing.assert_array_equal(decode_png(data, 64, 48), DEPTH)


@pytest.mark.parametrize("layout", [DEPTH[:, ::-1], DEPTH.T, DEPTH[::2, ::3]])
def test_depth_in_any_memory_layout_is_encoded(layout: NDArray[np.uint16]) -> None:
    height, width = layout.shape
    np.testing.assert_array_equal(decode_png(encode_png(layout), width, height), layout)


@pytest.mark.parametrize(
    ("data", "fault"),
    [
        (b"", "does not begin as one"),
        (b"no depth", "does not begin as one"),
        (GOOD[:30], "does not begin as one"),
        (GOOD[: len(GOOD) // 2], "cut off"),
        (GOOD[:-12], "cut off"),
        (GOOD[:-1], "cut off"),
        (GOOD[:60] + bytes([GOOD[60] ^ 1]) + GOOD[61:], "a checksum is wrong"),
        (_png(_header(640, 480), b""), "it is 640 × 480, and the message says 64 × 48"),
        (_png(_header(2**31 - 1, 2**31 - 1), b""), "it is 2147483647 ×"),
        (_png(_header(64, 48, bits=8), b""), "one channel of 16 bits"),
        (_png(_header(64, 48, kind=2), b""), "one channel of 16 bits"),
    ],
)
def test_damaged_png_is_refused_without_a_word_on_standard_error(
    data: bytes, fault: str, capfd: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(MessageError, match=f"damaged PNG: .*{fault}"):
        decode_depth(DepthImage("png16", 64, 48, data))
    assert capfd.readouterr().err == ""


def test_rows_that_are_missing_are_refused() -> None:
    with pytest.raises(MessageError, match="damaged PNG"):
        decode_png(_png(_header(64, 48), bytes(500)), 64, 48)
