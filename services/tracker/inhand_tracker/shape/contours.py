"""What is seen of an object from directions all around it: its contour, and its surface.

The sparse viewpoint model of contour trackers (Stoiber et al. 2020, 2022): points of the outline
with their normals and how thick the silhouette is there, points of the surface with their
normals, found once an object, so that a pose costs a look-up and some projections.
"""

from dataclasses import dataclass, fields
from functools import lru_cache

import cv2
import numpy as np
from numba import njit

from inhand_tracker.geometry.arrays import Array, Flags, Indices, Singles
from inhand_tracker.shape.parallel_view import along_curve, evenly, view_along
from inhand_tracker.shape.raster import nearest_faces
from inhand_tracker.shape.shape import ObjectShape

CONTOUR_POINTS = 50
SURFACE_POINTS = 50
RASTER = 256
MARGIN = 8
CHORD_PIXELS = 4
FARTHEST_M = 10.0
SMALL_HOLE = 0.08
"""The side of a hole that is no part of the outline, in sizes of the object."""


@dataclass(frozen=True)
class Contours:
    """For V ``directions`` (V, 3), unit, from the object to the viewer, in the object's frame:

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


def find_contours(shape: ObjectShape, directions: Array) -> Contours:
    """The contours of a shape from directions (V, 3), as if seen from far away."""
    views = [_look(shape, direction) for direction in directions]
    columns = {
        field.name: np.array([view[index] for view in views], np.float32)
        for index, field in enumerate(fields(Contours)[1:])
    }
    return Contours(directions.astype(np.float32), **columns)


@lru_cache(maxsize=1)
def _along_curve() -> Indices:
    """All the raster's pixels along Morton's curve."""
    row, column = np.indices((RASTER, RASTER)).reshape(2, -1)
    return along_curve(column, row)


def _look(shape: ObjectShape, direction: Array) -> tuple[Array | float, ...]:
    """The fields of ``Contours`` but for the direction."""
    view = view_along(shape, direction, RASTER, MARGIN)
    depths, owners = nearest_faces(view.pixels, view.depths, shape.faces, RASTER)
    mask = np.isfinite(depths)
    outline, flat_normals = _spaced_outline(_without_small_holes(mask))
    inside, outside = _thickness(mask, outline, flat_normals)
    order = _along_curve()
    silhouette = order[mask.ravel()[order]]
    row, column = np.divmod(silhouette[evenly(len(silhouette), SURFACE_POINTS)], RASTER)
    faces = owners[row, column]
    return (
        view.place(outline, depths),
        flat_normals @ view.axes[:2],
        np.where(np.isfinite(inside), inside / view.scale, FARTHEST_M),
        np.where(np.isfinite(outside), outside / view.scale, FARTHEST_M),
        view.place(np.column_stack((column, row)).astype(float), depths),
        _face_normals(shape, faces, direction),
        float(len(silhouette)) / view.scale**2,
    )


def _without_small_holes(mask: Flags) -> Flags:
    """The mask with what is as fine as the net of a racket filled in."""
    found, hierarchy = cv2.findContours(
        mask.astype(np.uint8), cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE
    )
    filled = mask.astype(np.uint8)
    for contour, (_, _, _, parent) in zip(found, hierarchy[0], strict=True):
        if parent >= 0 and cv2.contourArea(contour) < (SMALL_HOLE * RASTER) ** 2:
            cv2.drawContours(filled, [contour], 0, 1, cv2.FILLED)
    return filled.astype(bool)


def _spaced_outline(mask: Flags) -> tuple[Array, Array]:
    """CONTOUR_POINTS pixels (B, 2) equally spaced along all outlines, and outward normals."""
    found, _ = cv2.findContours(mask.astype(np.uint8), cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    around = [contour[:, 0, :].astype(float) for contour in found]
    normals = [_outline_normals(contour) for contour in around]
    steps = [np.linalg.norm(np.roll(c, -1, axis=0) - c, axis=1) for c in around]
    ends = np.cumsum(np.concatenate(steps))
    wanted = (np.arange(CONTOUR_POINTS) + 0.5) * ends[-1] / CONTOUR_POINTS
    chosen = np.minimum(np.searchsorted(ends, wanted), len(ends) - 1)
    return np.concatenate(around)[chosen], np.concatenate(normals)[chosen]


def _outline_normals(contour: Array) -> Array:
    """OpenCV goes round a component with its outside on the right-hand side of (x, y)-down."""
    if len(contour) < 3:
        return np.tile([1.0, 0.0], (len(contour), 1))
    reach = min(CHORD_PIXELS, (len(contour) - 1) // 2)
    chord = np.roll(contour, -reach, axis=0) - np.roll(contour, reach, axis=0)
    normals = np.column_stack((-chord[:, 1], chord[:, 0]))
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    # At the tip of what is one pixel thin the chord has no length: outwards is along it.
    ahead = contour - np.roll(contour, reach, axis=0)
    normals = np.where(lengths > 0.5, normals, ahead)
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)


def _face_normals(shape: ObjectShape, faces: Indices, direction: Array) -> Array:
    corners = shape.vertices[shape.faces[faces]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.where(length > 1e-15, normals / np.maximum(length, 1e-15), direction)
    return np.where(normals @ direction < 0.0, -1.0, 1.0)[:, None] * normals


@njit(cache=True, nogil=True)
def _thickness(mask: Flags, pixels: Array, normals: Array) -> tuple[Array, Array]:
    """How many pixels the mask goes on inwards, and its absence outwards; inf to the border."""
    height, width = mask.shape
    inside = np.empty(len(pixels))
    outside = np.full(len(pixels), np.inf)
    for point in range(len(pixels)):
        steps = 1
        while True:
            column = int(np.rint(pixels[point, 0] - steps * normals[point, 0]))
            row = int(np.rint(pixels[point, 1] - steps * normals[point, 1]))
            if not (0 <= column < width and 0 <= row < height) or not mask[row, column]:
                break
            steps += 1
        inside[point] = steps
        # A step and a half out, the normal's rounding no longer meets the outline itself.
        for step in range(2, width):
            column = int(np.rint(pixels[point, 0] + step * normals[point, 0]))
            row = int(np.rint(pixels[point, 1] + step * normals[point, 1]))
            if not (0 <= column < width and 0 <= row < height):
                break
            if mask[row, column]:
                outside[point] = step
                break
    return inside, outside
