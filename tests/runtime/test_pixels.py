"""Pixels to bytes and back."""

from collections.abc import Callable

import numpy as np
import pytest
import zstandard
from inhand_runtime.pixels import (
    decode_colour,
    decode_depth,
    decode_grey,
    decode_metres,
    encode_colour,
    encode_depth,
)
from inhand_schemas.errors import MessageError
from inhand_schemas.fields import DepthCodec
from inhand_schemas.messages import ColourImage, DepthImage
from inhand_tracker.geometry.arrays import Bytes
from numpy.typing import NDArray


@pytest.fixture
def colour() -> Bytes:
    """(48, 64, 3): red grows to the right, green downward."""
    picture = np.zeros((48, 64, 3), np.uint8)
    picture[..., 0] = np.arange(64) * 4
    picture[..., 1] = np.arange(48)[:, None] * 5
    return picture


@pytest.fixture
def depth() -> NDArray[np.uint16]:
    """(48, 64): all values from 0 up, holes included."""
    return np.arange(48 * 64, dtype=np.uint16).reshape(48, 64) * 21


def test_depth_survives_without_loss(depth: NDArray[np.uint16]) -> None:
    image = encode_depth(depth)
    assert (image.codec, image.width, image.height) == ("z16-zstd", 64, 48)
    decoded = decode_depth(image)
    assert decoded.dtype == np.uint16
    np.testing.assert_array_equal(decoded, depth)


@pytest.mark.parametrize("codec", ["z16", "z16-zstd", "png16"])
@pytest.mark.parametrize("width", [64, 31])
def test_depth_survives_every_codec(
    depth: NDArray[np.uint16], codec: DepthCodec, width: int
) -> None:
    image = encode_depth(depth[:, :width], codec)
    assert (image.codec, image.width, image.height) == (codec, width, 48)
    decoded = decode_depth(image)
    assert decoded.dtype == np.uint16
    np.testing.assert_array_equal(decoded, depth[:, :width])


@pytest.mark.parametrize("codec", ["z16", "z16-zstd", "png16"])
def test_depth_in_metres_is_that_in_units_times_their_length(
    depth: NDArray[np.uint16], codec: DepthCodec
) -> None:
    image = encode_depth(depth, codec)
    metres = decode_metres(image, 0.001)
    assert metres.dtype == np.float32
    np.testing.assert_array_equal(metres, decode_depth(image) * np.float32(0.001))
    decode_depth(image)[:] = 0  # what is decoded is the caller's own


def test_plain_depth_is_read_too(depth: NDArray[np.uint16]) -> None:
    plain = DepthImage("z16", 64, 48, depth.astype("<u2").tobytes())
    np.testing.assert_array_equal(decode_depth(plain), depth)


def test_colour_survives_nearly(colour: Bytes) -> None:
    decoded = decode_colour(encode_colour(colour))
    assert decoded.shape == colour.shape
    assert np.abs(decoded.astype(int) - colour).mean() < 4


def test_colour_in_any_memory_layout_is_encoded(colour: Bytes) -> None:
    assert encode_colour(colour[:, ::-1]) == encode_colour(colour[:, ::-1].copy())


def test_plain_colour_is_read_too(colour: Bytes) -> None:
    plain = ColourImage("rgb8", 64, 48, colour.tobytes())
    np.testing.assert_array_equal(decode_colour(plain), colour)


def test_grey_is_the_luminance_in_either_codec(colour: Bytes) -> None:
    luminance = colour @ (0.299, 0.587, 0.114)
    for image in (encode_colour(colour), ColourImage("rgb8", 64, 48, colour.tobytes())):
        assert np.abs(decode_grey(image) - luminance).mean() < 3


@pytest.mark.parametrize("decode", [decode_colour, decode_grey])
def test_a_damaged_jpeg_is_refused(colour: Bytes, decode: Callable[[ColourImage], Bytes]) -> None:
    data = encode_colour(colour).data
    for damaged in (b"", b"no jpeg", data[: len(data) // 2]):
        with pytest.raises(MessageError, match="damaged JPEG"):
            decode(ColourImage("jpeg", 64, 48, damaged))


def test_a_jpeg_of_another_size_is_refused(colour: Bytes) -> None:
    data = encode_colour(colour).data
    with pytest.raises(MessageError, match="it is 64 × 48, and the message says 640 × 480"):
        decode_colour(ColourImage("jpeg", 640, 480, data))


def test_damaged_depth_is_refused(depth: NDArray[np.uint16]) -> None:
    data = encode_depth(depth).data
    for damaged in (b"", b"no depth", data[: len(data) // 2]):
        with pytest.raises(MessageError, match="damaged depth"):
            decode_depth(DepthImage("z16-zstd", 64, 48, damaged))


@pytest.mark.parametrize("size", [2 * 64 * 48 - 2, 2 * 64 * 48 + 2, 100_000_000])
@pytest.mark.parametrize("says_its_size", [True, False])
def test_depth_that_does_not_fill_its_image_is_refused(size: int, says_its_size: bool) -> None:
    compressor = zstandard.ZstdCompressor(write_content_size=says_its_size)
    with pytest.raises(MessageError, match="damaged depth"):
        decode_depth(DepthImage("z16-zstd", 64, 48, compressor.compress(bytes(size))))


def test_colour_that_only_recordings_hold_is_refused() -> None:
    coded = ColourImage("h264", 64, 48, b"")
    for decode in (decode_colour, decode_grey):
        with pytest.raises(MessageError, match="from recordings alone"):
            decode(coded)
