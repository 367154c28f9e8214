"""A shape seen along one direction from far away, on a square raster."""

from dataclasses import dataclass

import numpy as np

from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.shape.shape import ObjectShape


@dataclass(frozen=True)
class ParallelView:
    """A mesh as it is seen from far away: its vertices at ``pixels`` (N, 2), ``scale`` pixels to
    the metre, with ``depths`` (N,).

    The rows of ``axes`` (3, 3) are right, down and forwards; ``low`` (2,) in metres is where the
    margin ends.
    """

    axes: Array
    low: Array
    scale: float
    margin: int
    pixels: Array
    depths: Array

    def place(self, pixels: Array, surface: Array) -> Array:
        """Place pixels (B, 2) of a surface of depths (R, R) in the object's frame, (B, 3)."""
        column, row = np.rint(pixels).astype(int).T
        across = (pixels - self.margin) / self.scale + self.low
        placed: Array = np.column_stack((across, surface[row, column])) @ self.axes
        return placed


def view_along(shape: ObjectShape, direction: Array, raster: int, margin: int) -> ParallelView:
    """See a shape from ``direction`` (3,), unit, as large as a raster and its margin let it be."""
    axes = view_axes(direction)
    seen = shape.vertices @ axes.T
    low, high = seen[:, :2].min(axis=0), seen[:, :2].max(axis=0)
    scale = (raster - 1 - 2 * margin) / max((high - low).max(), 1e-9)
    return ParallelView(axes, low, scale, margin, (seen[:, :2] - low) * scale + margin, seen[:, 2])


def view_axes(direction: Array) -> Array:
    """Return the axes (3, 3) of a viewer who looks at the object from ``direction``, by rows:
    right, down and forwards."""
    helper = np.eye(3)[np.argmin(np.abs(direction))]
    right = np.cross(helper, -direction)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(-direction, right), -direction])


def along_curve(column: Indices, row: Indices) -> Indices:
    """Order pixels (P,) along Morton's curve: neighbours on it are neighbours in the raster."""
    place = np.zeros_like(column)
    for bit in range(max(int(column.max()), int(row.max())).bit_length()):
        place |= ((column >> bit) & 1) << (2 * bit) | ((row >> bit) & 1) << (2 * bit + 1)
    return np.argsort(place)


def evenly(pixels: int, count: int) -> Indices:
    """Choose ``count`` of a number of ``pixels``, at one step from each other."""
    return ((np.arange(count) + 0.5) * pixels / count).astype(np.int64)
