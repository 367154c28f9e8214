"""Contours and surfaces of an object as they are seen from directions all around it.

The sparse viewpoint model of contour trackers (Stoiber et al. 2020, 2022): points of the outline
with their normals and how thick the silhouette is there, points of the surface with their
normals, found once an object, so that a pose costs a look-up and some projections.
"""

from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import lru_cache

import cv2
import numpy as np

from inhand_tracker.geometry.arrays import Array, Flags, Indices, Singles
from inhand_tracker.shape.kernels.measure_thickness import measure_thickness
from inhand_tracker.shape.parallel_view import along_curve, evenly, view_along
from inhand_tracker.shape.parameters import DEFAULT_SHAPE, ShapeParameters
from inhand_tracker.shape.raster import nearest_faces
from inhand_tracker.shape.shape import ObjectShape


@dataclass(frozen=True)
class Contours:
    """An object's contours from ``directions`` (V, 3), unit, from the object to the viewer, all in
    the object's frame.

    ``points`` (V, B, 3) of the outline, equally spaced, with outward unit ``normals`` (V, B, 3)
    in the plane of view; ``inside`` (V, B) and ``outside`` (V, B), how far in metres the
    silhouette goes on inwards and what is beside it outwards along the normal (10 m for ever);
    ``surface_points`` (V, S, 3), evenly spaced over what is seen, and their unit
    ``surface_normals`` (V, S, 3) towards the viewer; ``areas`` (V,) of the silhouette in m².
    """

    directions: Singles
    points: Singles
    normals: Singles
    inside: Singles
    outside: Singles
    surface_points: Singles
    surface_normals: Singles
    areas: Singles


def find_contours(
    shape: ObjectShape,
    directions: Array,
    parameters: ShapeParameters = DEFAULT_SHAPE,
    on_view: Callable[[], None] = lambda: None,
) -> Contours:
    """Find the contours of a shape from directions (V, 3), as if seen from far away.

    ``on_view`` is called after each of them.
    """
    views = []
    for direction in directions:
        views.append(_look(shape, direction, parameters))
        on_view()
    columns = {
        field.name: np.array([view[index] for view in views], np.float32)
        for index, field in enumerate(fields(Contours)[1:])
    }
    return Contours(directions.astype(np.float32), **columns)


@lru_cache(maxsize=1)
def _all_along_curve(raster: int) -> Indices:
    """Order all pixels of a square raster along Morton's curve."""
    row, column = np.indices((raster, raster)).reshape(2, -1)
    return along_curve(column, row)


def _look(
    shape: ObjectShape, direction: Array, parameters: ShapeParameters
) -> tuple[Array | float, ...]:
    """Find the fields of ``Contours`` but for the direction."""
    raster, endless = parameters.contour_raster, parameters.endless_m
    view = view_along(shape, direction, raster, parameters.contour_margin)
    depths, owners = nearest_faces(view.pixels, view.depths, shape.faces, (raster, raster))
    mask = np.isfinite(depths)
    whole = _without_small_holes(mask, (parameters.small_hole * raster) ** 2)
    outline, flat_normals = _spaced_outline(whole, parameters)
    inside, outside = measure_thickness(mask, outline, flat_normals)
    order = _all_along_curve(raster)
    silhouette = order[mask.ravel()[order]]
    chosen = silhouette[evenly(len(silhouette), parameters.surface_points)]
    row, column = np.divmod(chosen, raster)
    faces = owners[row, column]
    return (
        view.place(outline, depths),
        flat_normals @ view.axes[:2],
        np.where(np.isfinite(inside), inside / view.scale, endless),
        np.where(np.isfinite(outside), outside / view.scale, endless),
        view.place(np.column_stack((column, row)).astype(float), depths),
        _face_normals(shape, faces, direction),
        float(len(silhouette)) / view.scale**2,
    )


def _without_small_holes(mask: Flags, largest: float) -> Flags:
    """Fill the holes of a mask that have an area, in pixels, smaller than ``largest``."""
    found, hierarchy = cv2.findContours(
        mask.astype(np.uint8), cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE
    )
    filled = mask.astype(np.uint8)
    for contour, (_, _, _, parent) in zip(found, hierarchy[0], strict=True):
        if parent >= 0 and cv2.contourArea(contour) < largest:
            cv2.drawContours(filled, [contour], 0, 1, cv2.FILLED)
    return filled.astype(bool)


def _spaced_outline(mask: Flags, parameters: ShapeParameters) -> tuple[Array, Array]:
    """Find pixels (B, 2) equally spaced along all outlines, and their outward normals (B, 2)."""
    found, _ = cv2.findContours(mask.astype(np.uint8), cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    around = [contour[:, 0, :].astype(float) for contour in found]
    normals = [_outline_normals(contour, parameters.chord_pixels) for contour in around]
    steps = [np.linalg.norm(np.roll(c, -1, axis=0) - c, axis=1) for c in around]
    ends = np.cumsum(np.concatenate(steps))
    count = parameters.contour_points
    wanted = (np.arange(count) + 0.5) * ends[-1] / count
    chosen = np.minimum(np.searchsorted(ends, wanted), len(ends) - 1)
    return np.concatenate(around)[chosen], np.concatenate(normals)[chosen]


def _outline_normals(contour: Array, chord_pixels: int) -> Array:
    """Find the outward normals (N, 2) of a contour (N, 2), each across the chord between the
    pixels ``chord_pixels`` before and behind.

    OpenCV goes round a component with its outside on the right-hand side of (x, y)-down.
    """
    if len(contour) < 3:
        return np.tile([1.0, 0.0], (len(contour), 1))
    reach = min(chord_pixels, (len(contour) - 1) // 2)
    chord = np.roll(contour, -reach, axis=0) - np.roll(contour, reach, axis=0)
    normals = np.column_stack((-chord[:, 1], chord[:, 0]))
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    # At the tip of what is one pixel thin the chord has no length: outwards is along it.
    ahead = contour - np.roll(contour, reach, axis=0)
    normals = np.where(lengths > 0.5, normals, ahead)
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)


def _face_normals(shape: ObjectShape, faces: Indices, direction: Array) -> Array:
    """Find the unit normals (S, 3) of faces (S,), towards the viewer."""
    corners = shape.vertices[shape.faces[faces]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.where(length > 1e-15, normals / np.maximum(length, 1e-15), direction)
    return np.where(normals @ direction < 0.0, -1.0, 1.0)[:, None] * normals
