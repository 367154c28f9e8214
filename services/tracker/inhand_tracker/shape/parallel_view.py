"""A shape seen along one direction from far away, on a square raster."""

from dataclasses import dataclass

import numpy as np

from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.shape.shape import ObjectShape


@dataclass(frozen=True)
class ParallelView:
    """``axes`` (3, 3) are rows right, down and forwards; the vertices are at ``pixels`` (N, 2),
    ``scale`` to the metre, with ``depths`` (N,); ``low`` (2,) is where the margin ends."""

    axes: Array
    low: Array
    scale: float
    margin: int
    pixels: Array
    depths: Array

    def place(self, pixels: Array, surface: Array) -> Array:
        """The points (B, 3) at pixels (B, 2) of a surface of depths (R, R), in the object's
        frame."""
        column, row = np.rint(pixels).astype(int).T
        across = (pixels - self.margin) / self.scale + self.low
        placed: Array = np.column_stack((across, surface[row, column])) @ self.axes
        return placed


def view_along(shape: ObjectShape, direction: Array, raster: int, margin: int) -> ParallelView:
    """A shape from ``direction`` (3,), unit, as large as a raster and its margin let it be."""
    axes = view_axes(direction)
    seen = shape.vertices @ axes.T
    low, high = seen[:, :2].min(axis=0), seen[:, :2].max(axis=0)
    scale = (raster - 1 - 2 * margin) / max((high - low).max(), 1e-9)
    return ParallelView(axes, low, scale, margin, (seen[:, :2] - low) * scale + margin, seen[:, 2])


def view_axes(direction: Array) -> Array:
    """Rows: right, down and forwards of a viewer who looks at the object from ``direction``."""
    helper = np.eye(3)[np.argmin(np.abs(direction))]
    right = np.cross(helper, -direction)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(-direction, right), -direction])


def along_curve(column: Indices, row: Indices) -> Indices:
    """The order of pixels (P,) along Morton's curve: neighbours on it are neighbours in the
    raster."""
    place = np.zeros_like(column)
    for bit in range(max(int(column.max()), int(row.max())).bit_length()):
        place |= ((column >> bit) & 1) << (2 * bit) | ((row >> bit) & 1) << (2 * bit + 1)
    return np.argsort(place)


def evenly(pixels: int, count: int) -> Indices:
    """``count`` of so many pixels, at one step from each other."""
    return ((np.arange(count) + 0.5) * pixels / count).astype(np.int64)
