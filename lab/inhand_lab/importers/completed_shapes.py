"""Whole shapes from the part of a surface that was seen, where one knows what kind it is."""

import numpy as np
import trimesh
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.shape.shape import ObjectShape, Symmetry

from inhand_lab.importers.shapes import MIRROR_NORMAL, extreme_points

CUP_SECTIONS = 48
LIP_M = 0.003
WALL_M = 0.0005
BOTTOM_M = 0.002
TOLERANCE_M = 0.0015
FITTING_STEPS = 30


def complete_box(name: str, points: Array) -> ObjectShape:
    """The least box that holds points (N, 3): a box's three seen sides tell all of it."""
    to_box, extents = trimesh.bounds.oriented_bounds(points)  # type: ignore[no-untyped-call]
    return _shape(name, trimesh.creation.box(extents, np.linalg.inv(to_box)))


def complete_cup(name: str, points: Array) -> ObjectShape:
    """A hollow cup with a lip that stands along z, from points (N, 3) of its surface.

    It has no handle, and so looks the same turned about its axis.
    """
    low, top = float(points[:, 2].min()), float(points[:, 2].max())
    wall = points[(points[:, 2] > (low + top) / 2.0) & (points[:, 2] < top - 2.0 * LIP_M)]
    centre, radius = _circle(wall[:, :2])
    lip = np.linalg.norm(points[points[:, 2] > top - LIP_M, :2] - centre, axis=1)
    widest = float(np.quantile(lip, 0.95))
    inner = radius - WALL_M
    profile = [
        (0.0, low),
        (radius, low),
        (radius, top - LIP_M),
        (widest, top - 2.0 * WALL_M),
        (widest, top - WALL_M),
        (widest - 2.0 * WALL_M, top),
        (inner, top - LIP_M / 2.0),
        (inner, low + BOTTOM_M),
        (0.0, low + BOTTOM_M),
    ]
    mesh = trimesh.creation.revolve(np.array(profile), sections=CUP_SECTIONS)
    mesh.apply_translation([*centre, 0.0])
    middle = (float(centre[0]), float(centre[1]), (low + top) / 2.0)
    return _shape(name, mesh, (Symmetry((0.0, 0.0, 1.0), middle),))


def _circle(points: Array) -> tuple[Array, float]:
    """The centre (2,) and radius of the circle that most of the points (N, 2) lie on."""
    weights = np.ones(len(points))
    centre, radius = points.mean(axis=0), 0.0
    rows = np.column_stack((2.0 * points, np.ones(len(points))))
    for _ in range(FITTING_STEPS):
        solution, *_ = np.linalg.lstsq(
            rows * weights[:, None], np.square(points).sum(axis=1) * weights
        )
        centre, radius = solution[:2], float(np.sqrt(solution[2] + solution[:2] @ solution[:2]))
        off = np.linalg.norm(points - centre, axis=1) - radius
        weights = 1.0 / (1.0 + np.square(off / TOLERANCE_M))
    return centre, radius


def _shape(name: str, mesh: trimesh.Trimesh, symmetries: tuple[Symmetry, ...] = ()) -> ObjectShape:
    vertices = np.asarray(mesh.vertices, np.float64)
    faces = np.asarray(mesh.faces, np.int64)
    return ObjectShape(name, vertices, faces, extreme_points(vertices), MIRROR_NORMAL, symmetries)
