"""A rectangle of an image as a small camera of its own."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import ceil, floor

import numpy as np
from inhand_runtime.compiled import njit
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import Intrinsics

from inhand_lab.geometry.canvas import NEAREST_PAINTED_M, Canvas

WINDOW_MARGIN = 1
"""Width of the frame around what is looked for, pixels."""


@dataclass(frozen=True)
class Window:
    """Rows and columns of an image, and the intrinsics of the camera that sees just these."""

    rows: slice
    columns: slice
    intrinsics: Intrinsics

    @property
    def area(self) -> tuple[int, int, int, int]:
        """Top, bottom, left and right; bottom and right are not in it."""
        return self.rows.start, self.rows.stop, self.columns.start, self.columns.stop

    def cut(self, canvas: Canvas) -> Canvas:
        """This part of a canvas: a view, which shares its pixels."""
        area = self.rows, self.columns
        return Canvas(canvas.colour[area], canvas.inverse_depth[area], canvas.labels[area])


def window_around(intrinsics: Intrinsics, points: Array) -> Window:
    """The window that holds all points (V, 3) in the camera's frame; empty where none is seen.

    It is the whole image where a point is too near to be projected.
    """
    lens = intrinsics.fx, intrinsics.fy, intrinsics.cx, intrinsics.cy
    nearest, first_u, last_u, first_v, last_v = _bounds(points, lens)
    if nearest < NEAREST_PAINTED_M:
        return _window(intrinsics, 0, intrinsics.width, 0, intrinsics.height)
    left, right = _span(first_u, last_u, intrinsics.width)
    top, bottom = _span(first_v, last_v, intrinsics.height)
    return _window(intrinsics, left, right, top, bottom)


@njit(cache=True, nogil=True)
def _bounds(points, lens):  # type: ignore[no-untyped-def]
    """Depth of the nearest point, first and last column, first and last row of all."""
    fx, fy, cx, cy = lens
    nearest, first_u, last_u, first_v, last_v = np.inf, np.inf, -np.inf, np.inf, -np.inf
    for index in range(len(points)):
        z = points[index, 2]
        nearest = min(nearest, z)
        if nearest < NEAREST_PAINTED_M:
            break
        u, v = fx * points[index, 0] / z + cx, fy * points[index, 1] / z + cy
        first_u, last_u = min(first_u, u), max(last_u, u)
        first_v, last_v = min(first_v, v), max(last_v, v)
    return nearest, first_u, last_u, first_v, last_v


def _span(least: float, most: float, size: int) -> tuple[int, int]:
    first = min(max(floor(least) - WINDOW_MARGIN, 0), size)
    return first, min(max(ceil(most) + WINDOW_MARGIN + 1, first), size)


def _window(intrinsics: Intrinsics, left: int, right: int, top: int, bottom: int) -> Window:
    seen = replace(
        intrinsics,
        width=right - left,
        height=bottom - top,
        cx=intrinsics.cx - left,
        cy=intrinsics.cy - top,
    )
    return Window(slice(top, bottom), slice(left, right), seen)
