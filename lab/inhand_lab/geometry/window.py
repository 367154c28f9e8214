"""A rectangle of an image as a small camera of its own."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
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
    if points[:, 2].min() < NEAREST_PAINTED_M:
        return _window(intrinsics, 0, intrinsics.width, 0, intrinsics.height)
    u = intrinsics.fx * points[:, 0] / points[:, 2] + intrinsics.cx
    v = intrinsics.fy * points[:, 1] / points[:, 2] + intrinsics.cy
    left, right = _span(u, intrinsics.width)
    top, bottom = _span(v, intrinsics.height)
    return _window(intrinsics, left, right, top, bottom)


def _span(pixels: Array, size: int) -> tuple[int, int]:
    first = int(np.clip(np.floor(pixels.min()) - WINDOW_MARGIN, 0, size))
    return first, int(np.clip(np.ceil(pixels.max()) + WINDOW_MARGIN + 1, first, size))


def _window(intrinsics: Intrinsics, left: int, right: int, top: int, bottom: int) -> Window:
    seen = replace(
        intrinsics,
        width=right - left,
        height=bottom - top,
        cx=intrinsics.cx - left,
        cy=intrinsics.cy - top,
    )
    return Window(slice(top, bottom), slice(left, right), seen)
