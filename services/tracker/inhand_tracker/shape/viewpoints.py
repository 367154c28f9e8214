"""Visible boundaries and surfaces of an object, precomputed for directions all around it.

What is seen of an object hardly depends on more than the direction that it is seen from. So its
points are found once a direction, and a hypothesis costs a look-up and some projections (the
sparse viewpoint model of contour trackers, Stoiber et al. 2020).
"""

from dataclasses import dataclass

import cv2
import numpy as np
import trimesh

from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.shape.contours import Contours, find_contours
from inhand_tracker.shape.parallel_view import ParallelView, along_curve, evenly, view_along
from inhand_tracker.shape.raster import nearest_depths
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.shape.view_grid import nearest_views, view_grid

SUBDIVISIONS = 3
BOUNDARY_POINTS = 50
SURFACE_POINTS = 50
RASTER = 160
MARGIN = 4


@dataclass(frozen=True)
class Viewpoints:
    """``directions`` (V, 3), unit, from the object to the viewer, in the object's frame.

    ``boundaries`` (V, B, 3): equally spaced points of the visible boundary in the object's frame.
    ``surfaces`` (V, S, 3): evenly spaced points of the surface that is seen (what faces away or is
    hidden is left out); ``contours`` are for ``sight``. Both are None in models of older releases.
    """

    directions: Array
    boundaries: Array
    surfaces: Array | None = None
    contours: Contours | None = None


def find_viewpoints(shape: ObjectShape) -> Viewpoints:
    """The boundaries and surfaces of a shape from 642 directions."""
    directions = np.asarray(trimesh.creation.icosphere(SUBDIVISIONS).vertices, float)
    directions = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    views = [_see(shape, direction) for direction in directions]
    return Viewpoints(
        directions,
        np.array([_boundary(shape, view) for view in views]),
        np.array([_surface(view) for view in views]),
        find_contours(shape, directions),
    )


def find_surfaces(shape: ObjectShape, directions: Array) -> Array:
    """``Viewpoints.surfaces`` for given directions (V, 3)."""
    return np.array([_surface(_see(shape, direction)) for direction in directions])


class VisiblePoints:
    """The points that are seen of many hypotheses at once.

    ``directions`` (V, 3) are those of ``Viewpoints``, ``points`` (V, B, 3) one of its arrays.
    """

    def __init__(self, directions: Array, points: Array) -> None:
        self._points = points
        self._directions = np.ascontiguousarray(directions)
        self._grid = view_grid(directions)

    def place(self, translations: Array, orientations: Array) -> Array:
        """Points (P, B, 3) in the camera frame of object poses (P, 3) and (P, 4)."""
        towards_viewer = rotations.rotate(rotations.conjugate(orientations), -translations)
        views = nearest_views(self._grid, self._directions, towards_viewer)
        turns = np.swapaxes(rotations.to_matrix(orientations), -1, -2)
        return self._points[views] @ turns + translations[:, None, :]


@dataclass(frozen=True)
class _Seen:
    """A shape from one direction: ``depths`` (R, R), infinite where nothing is seen, and
    ``surface``, with those of the pixels just beside it."""

    view: ParallelView
    depths: Array
    surface: Array


def _see(shape: ObjectShape, direction: Array) -> _Seen:
    view = view_along(shape, direction, RASTER, MARGIN)
    depths = nearest_depths(view.pixels, view.depths, shape.faces, RASTER)
    # A point between two pixels of the boundary may round to one beside it.
    beside = np.asarray(cv2.erode(depths, np.ones((3, 3))), np.float64)
    return _Seen(view, depths, np.where(np.isfinite(depths), depths, beside))


def _boundary(shape: ObjectShape, seen: _Seen) -> Array:
    """Equally spaced boundary points (B, 3)."""
    mask = np.isfinite(seen.depths).astype(np.uint8)
    contours, _ = cv2.findContours(mask, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    around = [contour[:, 0, :].astype(float) for contour in contours]
    if all(len(contour) == 1 for contour in around):
        return np.repeat(shape.vertices.mean(axis=0)[None], BOUNDARY_POINTS, axis=0)
    return seen.view.place(_equally_spaced(around), seen.surface)


def _surface(seen: _Seen) -> Array:
    """Evenly spaced points (S, 3) of what is seen: steps along a curve that fills the raster."""
    row, column = np.nonzero(np.isfinite(seen.depths))
    along = along_curve(column, row)
    chosen = along[evenly(len(along), SURFACE_POINTS)]
    pixels = np.column_stack((column, row))[chosen].astype(float)
    return seen.view.place(pixels, seen.surface)


def _equally_spaced(contours: list[Array]) -> Array:
    """BOUNDARY_POINTS points along closed contours, at one spacing over all of them."""
    segments = [np.linalg.norm(np.roll(c, -1, axis=0) - c, axis=1) for c in contours]
    lengths = np.array([segment.sum() for segment in segments])
    positions = (np.arange(BOUNDARY_POINTS) + 0.5) * lengths.sum() / BOUNDARY_POINTS
    starts = np.concatenate(([0.0], np.cumsum(lengths)))
    chosen = []
    for contour, segment, start, end in zip(
        contours, segments, starts[:-1], starts[1:], strict=True
    ):
        along = positions[(positions >= start) & (positions < end)] - start
        knots = np.concatenate(([0.0], np.cumsum(segment)))
        closed = np.concatenate((contour, contour[:1]))
        chosen.append(
            np.column_stack([np.interp(along, knots, closed[:, axis]) for axis in range(2)])
        )
    return np.concatenate(chosen)
