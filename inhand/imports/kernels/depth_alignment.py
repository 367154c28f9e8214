"""Depth drawn into another view, pixel by pixel."""

import math

import numpy as np
from inhand_runtime.compiled import njit
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Units = NDArray[np.uint16]
NOTHING = 65535
"""A pixel into which nothing was drawn."""


@njit(cache=True, nogil=True)
def through_lens(
    x: float, y: float, lens: Floats, distortion: Floats, widest: float
) -> tuple[float, float]:
    """Return the pixel of a ray (x, y, 1), NaN beyond ``widest`` from the axis.

    ``lens`` (4,) is fx, fy, cx, cy, and ``distortion`` (8,) k1, k2, p1, p2, k3 to k6 as OpenCV has
    them.
    """
    square = x * x + y * y
    if not square <= widest * widest:
        return math.nan, math.nan
    k1, k2, p1, p2, k3, k4, k5, k6 = distortion
    scale = (1.0 + square * (k1 + square * (k2 + square * k3))) / (
        1.0 + square * (k4 + square * (k5 + square * k6))
    )
    across = x * scale + 2.0 * p1 * x * y + p2 * (square + 2.0 * x * x)
    down = y * scale + p1 * (square + 2.0 * y * y) + 2.0 * p2 * x * y
    return lens[0] * across + lens[2], lens[1] * down + lens[3]


@njit(cache=True, nogil=True)
def draw_depth(
    depth: Units,
    rays: Floats,
    motion: Floats,
    view: tuple[Floats, Floats, float],
    limits: tuple[float, float, float],
    drawn: Units,
) -> None:
    """Draw depth (H, W) into ``drawn`` (H', W'), the nearest surface before those behind it.

    ``rays`` (H + 1, W + 1, 2) are those of the corners of pixels, ``motion`` (3, 4) takes points to
    the view, which is (lens, distortion, widest) of ``through_lens``. ``limits`` are the metres of
    a unit, those within which nothing is seen, and the pixels by which a pixel's square is larger
    than it is.
    """
    lens, distortion, widest = view
    scale, closest, overlap = limits
    height, width = drawn.shape
    corner, z = np.empty((2, 2)), np.empty(2)
    for row in range(depth.shape[0]):
        for column in range(depth.shape[1]):
            metres = depth[row, column] * scale
            if metres <= 0.0:
                continue
            for end in range(2):
                x = rays[row + end, column + end, 0] * metres
                y = rays[row + end, column + end, 1] * metres
                z[end] = motion[2, 0] * x + motion[2, 1] * y + motion[2, 2] * metres + motion[2, 3]
                corner[end] = math.nan
                if z[end] > closest:
                    right = motion[0, 0] * x + motion[0, 1] * y + motion[0, 2] * metres
                    down = motion[1, 0] * x + motion[1, 1] * y + motion[1, 2] * metres
                    corner[end, 0], corner[end, 1] = through_lens(
                        (right + motion[0, 3]) / z[end],
                        (down + motion[1, 3]) / z[end],
                        lens,
                        distortion,
                        widest,
                    )
            units = np.round(0.5 * (z[0] + z[1]) / scale)
            if not (math.isfinite(corner.sum()) and units < NOTHING):
                continue
            left = max(math.ceil(min(corner[0, 0], corner[1, 0]) - overlap), 0)
            right_end = min(math.floor(max(corner[0, 0], corner[1, 0]) + overlap), width - 1)
            top = max(math.ceil(min(corner[0, 1], corner[1, 1]) - overlap), 0)
            bottom = min(math.floor(max(corner[0, 1], corner[1, 1]) + overlap), height - 1)
            for v in range(top, bottom + 1):
                for u in range(left, right_end + 1):
                    drawn[v, u] = min(drawn[v, u], np.uint16(units))
