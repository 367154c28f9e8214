"""Polygons that are burned into pictures."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

JPEG_BLOCK = 16
"""Pixels of the squares within which a JPEG mixes its pixels, colour at half the size included."""

Polygon = tuple[tuple[float, float], ...]
"""Corners as shares of the picture's width and height, (0, 0) at its upper left."""
Mask = NDArray[np.bool_]


def mask_of(polygons: Sequence[Polygon], width: int, height: int) -> Mask:
    """(H, W) whether a pixel lies in a polygon, or a neighbour of it does.

    A polygon that crosses itself covers all that it goes around. Neighbours count because an edge
    may touch them.
    """
    mask = np.zeros((height, width), bool)
    for polygon in polygons:
        mask |= _winding(polygon, width, height) != 0
    return _grown(mask)


def in_blocks(mask: Mask, size: int = JPEG_BLOCK) -> Mask:
    """Widen a mask (H, W) to whole squares of that size: none of them keeps a trace of it."""
    height, width = mask.shape
    padded = np.zeros((-(-height // size) * size, -(-width // size) * size), bool)
    padded[:height, :width] = mask
    blocks = padded.reshape(padded.shape[0] // size, size, padded.shape[1] // size, size)
    touched = blocks.any(axis=(1, 3))
    return np.kron(touched, np.ones((size, size), bool))[:height, :width]


def _winding(polygon: Polygon, width: int, height: int) -> NDArray[np.int32]:
    """(H, W) how often the polygon goes around the centre of each pixel."""
    x = (np.arange(width) + 0.5) / width
    y = ((np.arange(height) + 0.5) / height)[:, None]
    turns = np.zeros((height, width), np.int32)
    for (x0, y0), (x1, y1) in zip(polygon, (*polygon[1:], polygon[0]), strict=True):
        if y0 == y1:
            continue
        crosses = x0 + (y - y0) / (y1 - y0) * (x1 - x0) > x
        down, up = (y0 <= y) & (y < y1), (y1 <= y) & (y < y0)
        turns += (down & crosses).astype(np.int32) - (up & crosses).astype(np.int32)
    return turns


def _grown(mask: Mask) -> Mask:
    """Add each pixel's eight neighbours."""
    height, width = mask.shape
    padded = np.pad(mask, 1)
    grown = np.zeros_like(mask)
    for down in range(3):
        for right in range(3):
            grown |= padded[down : down + height, right : right + width]
    return grown
