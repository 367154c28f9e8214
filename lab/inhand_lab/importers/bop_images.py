"""Reads the images of BOP data sets: colour or grey, of 8 or 16 bits, and depth."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.importers.bop_scenes import BopFrame
from inhand_lab.importers.images import read_image

BYTE = 8
"""Number of bits of a pixel as messages have it."""


def grey_bits(frames: Iterable[BopFrame]) -> int:
    """Return the number of bits that the pixels of frames' colour use, 8 at least.

    Industrial cameras write 10 or 12 bits into 16: of these the upper eight are taken, the same
    ones in all frames. Where the first image has 8 bits no other one is read. Images that cannot be
    read are passed over.
    """
    largest = 0
    for path in (frame.colour for frame in frames if frame.colour is not None):
        try:
            pixels = read_image(path, cv2.IMREAD_UNCHANGED)
        except DatasetError:
            continue
        if pixels.dtype != np.uint16:
            return BYTE
        largest = max(largest, int(pixels.max()))
    return max(largest.bit_length(), BYTE)


def read_bop_pixels(
    frame: BopFrame, grey_bits: int
) -> tuple[NDArray[np.uint8] | None, NDArray[np.uint16] | None]:
    """Read a frame's RGB (H, W, 3) and depth (H, W), of which one may be None.

    Grey is three times the same. Raises DatasetError for files that cannot be read, and images that
    are not of one size.
    """
    colour = None if frame.colour is None else read_bop_colour(frame.colour, grey_bits)
    depth = None if frame.depth is None else read_bop_depth(frame.depth)
    if colour is None and depth is None:
        raise DatasetError(f"image {frame.number} has neither colour nor depth")
    if colour is not None and depth is not None and depth.shape != colour.shape[:2]:
        raise DatasetError(
            f"{frame.depth} is {depth.shape[1]} × {depth.shape[0]}, and {frame.colour} "
            f"{colour.shape[1]} × {colour.shape[0]}: they should be aligned"
        )
    return colour, depth


def read_bop_colour(path: Path, grey_bits: int) -> NDArray[np.uint8]:
    """Read RGB (H, W, 3) as the file has its pixels, the upper eight of ``grey_bits`` bits."""
    flags = cv2.IMREAD_COLOR_RGB | cv2.IMREAD_ANYDEPTH | cv2.IMREAD_IGNORE_ORIENTATION
    pixels = read_image(path, flags)
    if pixels.dtype not in (np.uint8, np.uint16):
        raise DatasetError(f"{path} is {pixels.dtype}, and colour is of 8 or 16 bits")
    return _upper_byte(pixels, grey_bits) if pixels.dtype == np.uint16 else pixels


def _upper_byte(pixels: NDArray[Any], bits: int) -> NDArray[np.uint8]:
    return np.minimum(pixels >> (bits - BYTE), 255).astype(np.uint8)


def read_bop_depth(path: Path) -> NDArray[np.uint16]:
    """Read depth (H, W) in its units; raises DatasetError for what has not 16 bits."""
    depth = read_image(path, cv2.IMREAD_UNCHANGED)
    if depth.dtype != np.uint16 or depth.ndim != 2:
        raise DatasetError(
            f"{path} is {depth.dtype} {depth.shape}, and depth is uint16 with one channel"
        )
    return depth
