"""Completes shapes of a known kind from the part of their surface that was seen."""

import numpy as np
import trimesh
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.shape.shape import ObjectShape, Symmetry

from inhand_lab.importers.parameters import DEFAULT_IMPORT, ImportParameters
from inhand_lab.importers.shapes import MIRROR_NORMAL, extreme_points


def complete_box(name: str, points: Array) -> ObjectShape:
    """Return the least box that holds points (N, 3): of a box three sides are enough."""
    to_box, extents = trimesh.bounds.oriented_bounds(points)  # type: ignore[no-untyped-call]
    return _shape(name, trimesh.creation.box(extents, np.linalg.inv(to_box)))


def complete_cup(
    name: str, points: Array, parameters: ImportParameters = DEFAULT_IMPORT
) -> ObjectShape:
    """Return a hollow cup with a lip, standing along z, from points (N, 3) of its surface.

    It has no handle, and so looks the same turned about its axis.
    """
    lip_m, wall_m = parameters.lip_m, parameters.wall_m
    low, top = float(points[:, 2].min()), float(points[:, 2].max())
    wall = points[(points[:, 2] > (low + top) / 2.0) & (points[:, 2] < top - 2.0 * lip_m)]
    centre, radius = _fit_circle(wall[:, :2], parameters)
    lip = np.linalg.norm(points[points[:, 2] > top - lip_m, :2] - centre, axis=1)
    widest = float(np.quantile(lip, 0.95))
    inner = radius - wall_m
    profile = [
        (0.0, low),
        (radius, low),
        (radius, top - lip_m),
        (widest, top - 2.0 * wall_m),
        (widest, top - wall_m),
        (widest - 2.0 * wall_m, top),
        (inner, top - lip_m / 2.0),
        (inner, low + parameters.bottom_m),
        (0.0, low + parameters.bottom_m),
    ]
    mesh = trimesh.creation.revolve(np.array(profile), sections=parameters.cup_sections)
    mesh.apply_translation([*centre, 0.0])
    middle = (float(centre[0]), float(centre[1]), (low + top) / 2.0)
    return _shape(name, mesh, (Symmetry((0.0, 0.0, 1.0), middle),))


def _fit_circle(points: Array, parameters: ImportParameters) -> tuple[Array, float]:
    """Fit the centre (2,) and radius of the circle that most of the points (N, 2) lie on."""
    weights = np.ones(len(points))
    centre, radius = points.mean(axis=0), 0.0
    rows = np.column_stack((2.0 * points, np.ones(len(points))))
    for _ in range(parameters.circle_steps):
        solution, *_ = np.linalg.lstsq(
            rows * weights[:, None], np.square(points).sum(axis=1) * weights
        )
        centre, radius = solution[:2], float(np.sqrt(solution[2] + solution[:2] @ solution[:2]))
        off = np.linalg.norm(points - centre, axis=1) - radius
        weights = 1.0 / (1.0 + np.square(off / parameters.circle_tolerance_m))
    return centre, radius


def _shape(name: str, mesh: trimesh.Trimesh, symmetries: tuple[Symmetry, ...] = ()) -> ObjectShape:
    vertices = np.asarray(mesh.vertices, np.float64)
    faces = np.asarray(mesh.faces, np.int64)
    return ObjectShape(name, vertices, faces, extreme_points(vertices), MIRROR_NORMAL, symmetries)
