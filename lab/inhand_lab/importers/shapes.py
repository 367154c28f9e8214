"""Makes shapes of measured objects, from a mesh or from points alone.

The data name no plane of symmetry, so the shapes take the x axis for its normal; that matters only
where a left-handed person is tracked with what right-handed people showed, or the reverse.
"""

import itertools
import re
from pathlib import Path

import numpy as np
import trimesh
from inhand_runtime.errors import InhandError
from inhand_schemas.errors import KeyFormatError
from inhand_schemas.keys import require_name
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.shape.mesh_file import read_mesh
from inhand_tracker.shape.shape import ObjectShape

from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.importers.parameters import DEFAULT_IMPORT

MIRROR_NORMAL = np.array([1.0, 0.0, 0.0])

_CORNERS = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
_TETRAHEDRON = (
    np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]) * DEFAULT_IMPORT.thinnest_m / 2.0
)


def object_name(text: str) -> str:
    """Turn a text into a name for keys, ``golfClub`` → ``golf_club``; raises DatasetError."""
    name = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", text).lower()
    name = re.sub(r"[^a-z0-9]+", "_", name).strip("_")
    try:
        require_name("object", name)
    except KeyFormatError as error:
        raise DatasetError(str(error)) from None
    return name


def shape_of_mesh(name: str, path: Path, marked_vertices: Array | None = None) -> ObjectShape:
    """Read the mesh in a file, in metres; raises DatasetError.

    Its extreme points are marked where no others are given.
    """
    try:
        vertices, faces = read_mesh(path)
    except InhandError as error:
        raise DatasetError(str(error)) from None
    marked = extreme_points(vertices) if marked_vertices is None else marked_vertices
    return ObjectShape(name, vertices, faces, marked, MIRROR_NORMAL)


def shape_of_points(name: str, points: Array, marked_vertices: Array | None = None) -> ObjectShape:
    """Return the convex hull of points (N, 3), for an object without a mesh.

    The hull fills hollows and lacks what no point covers. Points that are flat to within 1 cm (or
    on a line, or a single one) become a body all the same: each is replaced by the corners of a
    tetrahedron, which reach 9 mm from it, 5 mm along each axis.
    """
    centred = points - points.mean(axis=0)
    axes = np.linalg.eigh(centred.T @ centred)[1]
    flat = np.ptp(centred @ axes, axis=0).min() < DEFAULT_IMPORT.thinnest_m
    body = (points[:, None] + _TETRAHEDRON).reshape(-1, 3) if flat else points
    hull = trimesh.convex.convex_hull(body)
    return ObjectShape(
        name,
        np.asarray(hull.vertices, np.float64),
        np.asarray(hull.faces, np.int64),
        extreme_points(points) if marked_vertices is None else marked_vertices,
        MIRROR_NORMAL,
    )


def extreme_points(points: Array) -> Array:
    """Return the points (M ≤ 8, 3) that reach farthest to the corners of the points' (N, 3) box."""
    low, high = points.min(axis=0), points.max(axis=0)
    scaled = (points - (low + high) / 2.0) / np.maximum(high - low, 1e-9)
    return points[np.unique(np.argmax(scaled @ _CORNERS.T, axis=0))]
