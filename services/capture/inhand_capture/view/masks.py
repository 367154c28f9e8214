"""Polygons that are burned into pictures."""

from collections.abc import Iterator, Sequence
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

JPEG_BLOCK = 16
"""Pixels of the squares within which a JPEG mixes its pixels, colour at half the size included."""

Corner = tuple[float, float]
"""Shares of the picture's width and height, (0, 0) at its upper left."""
Polygon = tuple[Corner, ...]
Mask = NDArray[np.bool_]
P = TypeVar("P", np.uint8, np.uint16)


def mask_of(polygons: Sequence[Polygon], width: int, height: int) -> Mask:
    """(H, W) whether a pixel's centre lies in a polygon, or an edge passes through it.

    A polygon that crosses itself covers all that it goes around, and one that is thinner than a
    pixel the pixels of its edges.
    """
    mask = np.zeros((height, width), bool)
    for polygon in polygons:
        mask |= _winding(polygon, width, height) != 0
        for start, end in _edges(polygon):
            mask[_pixels_between(start, end, width, height)] = True
    return mask


def in_blocks(mask: Mask, size: int = JPEG_BLOCK) -> Mask:
    """Widen a mask (H, W) to whole squares of that size: none of them keeps a trace of it."""
    height, width = mask.shape
    padded = np.zeros((-(-height // size) * size, -(-width // size) * size), bool)
    padded[:height, :width] = mask
    blocks = padded.reshape(padded.shape[0] // size, size, padded.shape[1] // size, size)
    touched = blocks.any(axis=(1, 3))
    return np.kron(touched, np.ones((size, size), bool))[:height, :width]


def without(picture: NDArray[P], mask: Mask) -> NDArray[P]:
    """Return a copy of a picture (H, W, …) in which what a mask (H, W) covers is 0."""
    hidden = picture.copy()
    hidden[mask] = 0
    return hidden


def _winding(polygon: Polygon, width: int, height: int) -> NDArray[np.int32]:
    """(H, W) how often the polygon goes around the centre of each pixel."""
    x = (np.arange(width) + 0.5) / width
    y = ((np.arange(height) + 0.5) / height)[:, None]
    turns = np.zeros((height, width), np.int32)
    for (x0, y0), (x1, y1) in _edges(polygon):
        if y0 == y1:
            continue
        crosses = x0 + (y - y0) / (y1 - y0) * (x1 - x0) > x
        down, up = (y0 <= y) & (y < y1), (y1 <= y) & (y < y0)
        turns += (down & crosses).astype(np.int32) - (up & crosses).astype(np.int32)
    return turns


def _edges(polygon: Polygon) -> Iterator[tuple[Corner, Corner]]:
    """Each corner with the next one."""
    return zip(polygon, (*polygon[1:], polygon[0]), strict=True)


def _pixels_between(
    start: Corner, end: Corner, width: int, height: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Rows and columns of the pixels on a line, looked for at each half a pixel."""
    size = np.array((width, height))
    length = np.abs((np.array(end) - start) * size).max()
    share = np.linspace(0.0, 1.0, 2 * int(np.ceil(length)) + 1)[:, None]
    points = (start + share * (np.array(end) - start)) * size
    columns, rows = np.minimum(points.astype(np.int64), size - 1).T
    return rows, columns
