"""Visible boundaries and surfaces of an object, precomputed for directions all around it.

What is seen of an object depends on little more than the direction that it is seen from. So its
points are found once for each direction, and a hypothesis costs a look-up and some projections
(the sparse viewpoint model of contour trackers, Stoiber et al. 2020).
"""

from collections.abc import Callable
from dataclasses import dataclass

import cv2
import numpy as np

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.shape.contours import Contours, find_contours
from inhand_tracker.shape.parallel_view import ParallelView, along_curve, evenly, view_along
from inhand_tracker.shape.parameters import DEFAULT_SHAPE, ShapeParameters
from inhand_tracker.shape.raster import nearest_depths
from inhand_tracker.shape.shape import ObjectShape


@dataclass(frozen=True)
class Viewpoints:
    """An object's points as they are seen from ``directions`` (V, 3), unit, from the object to the
    viewer, all in the object's frame.

    ``boundaries`` (V, B, 3) are equally spaced points of the visible boundary, ``surfaces``
    (V, S, 3) evenly spaced points of the visible surface (what faces away or is hidden is left
    out); ``contours`` are for ``sight``. Both are None in models of older releases.
    """

    directions: Array
    boundaries: Array
    surfaces: Array | None = None
    contours: Contours | None = None


def count_views(parameters: ShapeParameters = DEFAULT_SHAPE) -> int:
    """Return the number of views that ``find_viewpoints`` draws: two from each direction."""
    return 2 * (10 * 4**parameters.subdivisions + 2)


def find_viewpoints(
    shape: ObjectShape,
    parameters: ShapeParameters = DEFAULT_SHAPE,
    on_view: Callable[[], None] = lambda: None,
) -> Viewpoints:
    """Find the boundaries, surfaces and contours of a shape from directions all around it.

    ``on_view`` is called after each of ``count_views`` views: of a fine mesh one takes a second.
    Needs the extra ``lab``.
    """
    import trimesh

    sphere = trimesh.creation.icosphere(parameters.subdivisions)
    directions = np.asarray(sphere.vertices, float)
    directions = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    boundaries, surfaces = [], []
    for direction in directions:
        view = _see(shape, direction, parameters)
        boundaries.append(_boundary(shape, view, parameters.boundary_points))
        surfaces.append(_surface(view, parameters.surface_points))
        on_view()
    contours = find_contours(shape, directions, parameters, on_view)
    return Viewpoints(directions, np.array(boundaries), np.array(surfaces), contours)


def find_surfaces(
    shape: ObjectShape, directions: Array, parameters: ShapeParameters = DEFAULT_SHAPE
) -> Array:
    """Find ``Viewpoints.surfaces`` for given directions (V, 3)."""
    views = [_see(shape, direction, parameters) for direction in directions]
    return np.array([_surface(view, parameters.surface_points) for view in views])


@dataclass(frozen=True)
class _Seen:
    """A shape from one direction: ``depths`` (R, R), infinite where nothing is seen, and
    ``surface``, with those of the pixels just beside it."""

    view: ParallelView
    depths: Array
    surface: Array


def _see(shape: ObjectShape, direction: Array, parameters: ShapeParameters) -> _Seen:
    raster = parameters.boundary_raster
    view = view_along(shape, direction, raster, parameters.boundary_margin)
    depths = nearest_depths(view.pixels, view.depths, shape.faces, (raster, raster))
    # A point between two pixels of the boundary may round to one beside it.
    beside = np.asarray(cv2.erode(depths, np.ones((3, 3))), np.float64)
    return _Seen(view, depths, np.where(np.isfinite(depths), depths, beside))


def _boundary(shape: ObjectShape, seen: _Seen, count: int) -> Array:
    """Find ``count`` equally spaced boundary points (B, 3)."""
    mask = np.isfinite(seen.depths).astype(np.uint8)
    contours, _ = cv2.findContours(mask, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    around = [contour[:, 0, :].astype(float) for contour in contours]
    if all(len(contour) == 1 for contour in around):
        return np.repeat(shape.vertices.mean(axis=0)[None], count, axis=0)
    return seen.view.place(_equally_spaced(around, count), seen.surface)


def _surface(seen: _Seen, count: int) -> Array:
    """Find ``count`` evenly spaced points (S, 3) of what is seen: steps along a curve that fills
    the raster."""
    row, column = np.nonzero(np.isfinite(seen.depths))
    along = along_curve(column, row)
    chosen = along[evenly(len(along), count)]
    pixels = np.column_stack((column, row))[chosen].astype(float)
    return seen.view.place(pixels, seen.surface)


def _equally_spaced(contours: list[Array], count: int) -> Array:
    """Find ``count`` points along closed contours, at one spacing over all of them."""
    segments = [np.linalg.norm(np.roll(c, -1, axis=0) - c, axis=1) for c in contours]
    lengths = np.array([segment.sum() for segment in segments])
    positions = (np.arange(count) + 0.5) * lengths.sum() / count
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
