"""Colour that stands in a recording as H.264: a picture by what changed since the one before it.

Each picture names the one that it builds on by its digest, so that none is ever decoded upon
another one: where that is missing, it cannot be read, nor can what follows until one begins anew.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from threading import Lock
from typing import Any

import msgspec
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import ColourImage
from xxhash import xxh3_64_intdigest

from inhand_runtime.recording.layout import RecordingError

LONGEST_CHAIN = 240
"""Pictures until one begins anew, at the most."""
LONGEST_CHAIN_NS = 1_000_000_000
"""Time of capture until one begins anew, at the most."""
MACROBLOCK = 16
"""H.264 codes squares of so many pixels, of which a picture may use the last ones in part."""
_DIGEST_BITS = (1 << 63) - 1


class _Codec(msgspec.Struct):
    codec: str


class _Look(msgspec.Struct):
    """As much of a frame as tells whether its colour is H.264: no pixels are copied for it."""

    colour: _Codec | None = None


class _Coloured(msgspec.Struct):
    """A frame's colour."""

    colour: ColourImage | None = None


_look = msgspec.msgpack.Decoder(_Look)
_coloured = msgspec.msgpack.Decoder(_Coloured)


def coded_image(payload: bytes) -> ColourImage | None:
    """Return the colour of an encoded frame where that is H.264."""
    try:
        look = _look.decode(payload).colour
        if look is None or look.codec != "h264":
            return None
        return _coloured.decode(payload).colour
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError):
        return None  # it cannot be decoded, which its reader finds


def digest_of(image: ColourImage) -> int:
    """The digest by which the next picture names this one."""
    return xxh3_64_intdigest(image.data, image.builds_on or 0) & _DIGEST_BITS


@dataclass(frozen=True)
class CodedPicture:
    """One picture as H.264; ``before`` finds the one before it, or None where there is none."""

    image: ColourImage
    before: Callable[[], CodedPicture | None]
    decoder: ColourDecoder

    @property
    def digest(self) -> int:
        """The digest by which the next picture names this one."""
        return digest_of(self.image)

    def decoded(self) -> ColourImage:
        """The picture as ``rgb8``.

        Raises MessageError where it is damaged or builds on one that is not there, and
        RecordingError where PyAV is not installed.
        """
        return self.decoder.decode(self)


class ColourDecoder:
    """Decodes pictures of one key, from any thread: the next one at once, and any other one from
    where its chain begins."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._codec: Any = None
        self._digest: int | None = None
        self._image: ColourImage | None = None

    def decode(self, picture: CodedPicture) -> ColourImage:
        """Decode a picture, as its ``decoded`` says."""
        with self._lock:
            if self._image is None or picture.digest != self._digest:
                self._image = self._decode_chain(self._chain(picture))
                self._digest = picture.digest
            return self._image

    def _chain(self, picture: CodedPicture) -> list[CodedPicture]:
        """Return the pictures that have to be decoded, the given one first."""
        chain = [picture]
        while (builds_on := chain[-1].image.builds_on) is not None and builds_on != self._digest:
            before = chain[-1].before()
            if before is None or before.digest != builds_on:
                raise MessageError("its colour builds on a picture that is not there")
            if len(chain) == LONGEST_CHAIN:
                raise MessageError(f"its colour builds on more than {LONGEST_CHAIN} pictures")
            chain.append(before)
        return chain

    def _decode_chain(self, chain: list[CodedPicture]) -> ColourImage:
        """Decode pictures, the last one first, and return the first."""
        try:
            *before, last = (one.image for one in reversed(chain))
            for one in before:
                self._decode(one)
            pixels = self._decode(last).to_ndarray(format="rgb24").tobytes()
        except BaseException:
            self._codec = self._digest = self._image = None
            raise
        return ColourImage("rgb8", last.width, last.height, pixels)

    def _decode(self, image: ColourImage) -> Any:
        """Decode the next picture, and return PyAV's frame."""
        av = _pyav()
        if image.builds_on is None or self._codec is None:
            self._codec = av.CodecContext.create("h264", "r")
            # One thread: others would hand out pictures later.
            self._codec.thread_count = 1
            # What is damaged may say that it is as large as nobody has memory for.
            most = (image.width + MACROBLOCK) * (image.height + MACROBLOCK)
            self._codec.options = {"max_pixels": str(most)}
        try:
            frames = self._codec.decode(av.Packet(image.data))
        except av.FFmpegError as error:
            raise MessageError(f"damaged H.264: {error}") from None
        if len(frames) != 1 or frames[0].is_corrupt:
            raise MessageError(f"damaged H.264: {len(frames)} whole pictures in place of one")
        (frame,) = frames
        if (frame.width, frame.height) != (image.width, image.height):
            raise MessageError(
                f"damaged H.264: it is {frame.width} × {frame.height}, and the message says "
                f"{image.width} × {image.height}"
            )
        return frame


class ColourChains:
    """Links the pictures of messages that are read one after another, each to the one before."""

    def __init__(self) -> None:
        self._latest: dict[str, CodedPicture] = {}
        self._lengths: dict[str, int] = {}
        self._decoders: dict[str, ColourDecoder] = {}

    def next_picture(self, key: str, payload: bytes) -> CodedPicture | None:
        """Return the colour of the next frame of a key where that is H.264."""
        image = coded_image(payload)
        if image is None:
            return None
        length = self._lengths.get(key, 0) + 1 if image.builds_on is not None else 1
        # What builds on more cannot be decoded, and is not held.
        before = self._latest.get(key) if 1 < length <= LONGEST_CHAIN else None
        self._lengths[key] = length
        decoder = self._decoders.setdefault(key, ColourDecoder())
        self._latest[key] = picture = CodedPicture(image, lambda: before, decoder)
        return picture


def _pyav() -> Any:
    try:
        import av
    except ModuleNotFoundError:
        raise RecordingError(
            'the colour of this recording is H.264, which needs PyAV: pip install "inhand[h264]"'
        ) from None
    return av
