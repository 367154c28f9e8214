"""Visible boundaries of an object, precomputed for directions all around it.

The boundary of a projected object hardly depends on more than the direction that it is seen from.
So its points are found once a direction, and a hypothesis costs a look-up and some projections
(the sparse viewpoint model of contour trackers, Stoiber et al. 2020).
"""

from dataclasses import dataclass

import cv2
import numpy as np
import trimesh
from numpy.typing import NDArray
from scipy.spatial import KDTree

from inhand_tracker import rotations
from inhand_tracker.camera import Intrinsics
from inhand_tracker.raster import nearest_depths
from inhand_tracker.shape import ObjectShape

Array = NDArray[np.float64]

SUBDIVISIONS = 3
BOUNDARY_POINTS = 50
RASTER = 160
MARGIN = 4


@dataclass(frozen=True)
class Viewpoints:
    """``directions`` (V, 3), unit, from the object to the viewer, in the object's frame.

    ``boundaries`` (V, B, 3): equally spaced points of the visible boundary in the object's frame.
    """

    directions: Array
    boundaries: Array


def find_viewpoints(shape: ObjectShape) -> Viewpoints:
    """The boundaries of a shape from 642 directions."""
    directions = np.asarray(trimesh.creation.icosphere(SUBDIVISIONS).vertices, float)
    directions = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    return Viewpoints(directions, np.array([_boundary(shape, view) for view in directions]))


class BoundaryProjector:
    """Projects the boundary points of many hypotheses at once."""

    def __init__(self, viewpoints: Viewpoints) -> None:
        self._boundaries = viewpoints.boundaries
        self._tree = KDTree(viewpoints.directions)

    def project(self, translations: Array, orientations: Array, camera: Intrinsics) -> Array:
        """Pixels (P, B, 2) of object poses (P, 3) and (P, 4); NaN behind the camera."""
        towards_viewer = rotations.rotate(rotations.conjugate(orientations), -translations)
        length = np.linalg.norm(towards_viewer, axis=1, keepdims=True)
        _, views = self._tree.query(towards_viewer / np.maximum(length, 1e-9))
        matrices = rotations.to_matrix(orientations)
        points = np.einsum("pij,pbj->pbi", matrices, self._boundaries[views])
        return camera.project(points + translations[:, None, :])


def _boundary(shape: ObjectShape, view: Array) -> Array:
    """Equally spaced boundary points (B, 3) seen along one direction, from far away."""
    axes = _view_axes(view)
    seen = shape.vertices @ axes.T
    low, high = seen[:, :2].min(axis=0), seen[:, :2].max(axis=0)
    scale = (RASTER - 1 - 2 * MARGIN) / max((high - low).max(), 1e-9)
    pixels = (seen[:, :2] - low) * scale + MARGIN
    depths = nearest_depths(pixels, seen[:, 2], shape.faces, RASTER)
    mask = np.isfinite(depths).astype(np.uint8)
    contours, _ = cv2.findContours(mask, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    around = [contour[:, 0, :].astype(float) for contour in contours]
    if all(len(contour) == 1 for contour in around):
        return np.repeat(shape.vertices.mean(axis=0)[None], BOUNDARY_POINTS, axis=0)
    chosen = _equally_spaced(around)
    column, row = np.rint(chosen).astype(int).T
    in_view = np.column_stack(((chosen - MARGIN) / scale + low, depths[row, column]))
    points: Array = in_view @ axes
    return points


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


def _view_axes(view: Array) -> Array:
    """Rows: right, down and forwards of a viewer who looks at the object from ``view``."""
    helper = np.eye(3)[np.argmin(np.abs(view))]
    right = np.cross(helper, -view)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(-view, right), -view])
