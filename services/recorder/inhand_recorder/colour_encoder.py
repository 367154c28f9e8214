"""Colour as H.264, one picture at a time: none waits for a later one, none needs a later one."""

import importlib
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from inhand_runtime.pixels import decode_colour
from inhand_runtime.recording.coded_colour import LONGEST_CHAIN, LONGEST_CHAIN_NS, digest_of
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import ColourImage

_ANY, _BEGINNING = 0, 1
"""FFmpeg's numbers of kinds of pictures: as the encoder likes, or one that builds on none."""


@dataclass(frozen=True)
class ColourQuality:
    """How pictures are coded: x264's constant rate factor, of which 23 is its default and 6 less is
    about twice the bytes, and how much time it takes for that."""

    rate_factor: int = 23
    preset: str = "veryfast"


QUALITY = ColourQuality()


def load_pyav() -> Any:
    """Load PyAV; raises ModuleNotFoundError where it is not installed."""
    return importlib.import_module("av")


class ColourEncoder:
    """Codes the pictures of one camera, each upon the one before; raises ModuleNotFoundError where
    PyAV is not installed."""

    def __init__(self) -> None:
        self._av: Any = load_pyav()
        self._codec: Any = None
        self._shape: tuple[int, int] | None = None
        self._number = 0
        self._digest: int | None = None
        self._began = 0
        self._began_ns = 0

    def encode(self, image: ColourImage, captured_ns: int) -> ColourImage:
        """Code the next picture.

        Raises MessageError for one that is damaged, or that H.264 cannot hold; the next one then
        begins anew.
        """
        try:
            return self._encode(image, captured_ns)
        except BaseException:
            self.begin_anew()
            raise

    def begin_anew(self) -> None:
        """Let the next picture build on none."""
        self._digest = None

    def _encode(self, image: ColourImage, captured_ns: int) -> ColourImage:
        if image.width % 2 or image.height % 2:
            raise MessageError(f"H.264 holds no image of {image.width} × {image.height}")
        pixels = decode_colour(image)
        if self._shape != pixels.shape[:2]:
            self._open(*pixels.shape[:2])
        anew = self._digest is None or self._is_far(captured_ns)
        coded = ColourImage(
            "h264",
            image.width,
            image.height,
            self._code(pixels, anew),
            None if anew else self._digest,
        )
        if anew:
            self._began, self._began_ns = self._number, captured_ns
        self._number += 1
        self._digest = digest_of(coded)
        return coded

    def _is_far(self, captured_ns: int) -> bool:
        """Whether the picture that the chain begins with is as far back as it may be."""
        apart_ns = captured_ns - self._began_ns
        return self._number - self._began >= LONGEST_CHAIN or not 0 <= apart_ns < LONGEST_CHAIN_NS

    def _open(self, height: int, width: int) -> None:
        codec = self._av.CodecContext.create("libx264", "w")
        codec.width, codec.height = width, height
        # The whole range of values and BT.601, as in JPEG.
        codec.pix_fmt, codec.color_range, codec.colorspace = "yuvj420p", 2, 5
        codec.time_base, codec.framerate = Fraction(1, 30), Fraction(30)
        codec.thread_count, codec.max_b_frames, codec.gop_size = 1, 0, LONGEST_CHAIN + 1
        codec.options = {
            "preset": QUALITY.preset,
            "tune": "zerolatency",
            "crf": str(QUALITY.rate_factor),
            "forced-idr": "1",
            "x264-params": "annexb=1:repeat-headers=1:scenecut=0",
        }
        self._codec, self._shape = codec, (height, width)
        self.begin_anew()

    def _code(self, pixels: Any, anew: bool) -> bytes:
        frame = self._av.VideoFrame.from_ndarray(pixels, format="rgb24")
        frame = frame.reformat(format="yuvj420p", dst_color_range="JPEG", dst_colorspace="ITU601")
        frame.pts, frame.time_base = self._number, Fraction(1, 30)
        frame.pict_type = _BEGINNING if anew else _ANY
        try:
            packets = self._codec.encode(frame)
        except self._av.FFmpegError as error:
            self._shape = None
            raise MessageError(f"H.264: {error}") from None
        if len(packets) != 1:
            self._shape = None
            raise MessageError(f"H.264: {len(packets)} coded pictures of one")
        return bytes(packets[0])
