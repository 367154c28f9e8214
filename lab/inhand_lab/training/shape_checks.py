"""Checks whether an object's mesh and marks are metres, and belong together.

Each mistake is one line that says the size, or how far the marks lie, and the mend.
"""

from pathlib import Path

import numpy as np
import trimesh
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.shape.shape import ObjectShape

from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.training.parameters import DEFAULT_TRAINING

_UNITS = {"millimetres": 0.001, "centimetres": 0.01, "inches": 0.0254}
_TURNS = {
    "y points up in the mesh": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]),
    "y points down in the mesh": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]),
}


def check_shape(shape: ObjectShape, folder: Path) -> None:
    """Check the shape that was read from a folder; raises DatasetError where it cannot be meant."""
    _check_size(shape, folder)
    _check_spread(shape.marked_vertices, folder)
    _check_distance(shape, folder)


def _check_size(shape: ObjectShape, folder: Path) -> None:
    size = _size(shape.vertices)
    if DEFAULT_TRAINING.smallest_m <= size <= DEFAULT_TRAINING.largest_m:
        return
    raise DatasetError(
        f"{folder}: the mesh is {_length(size)} long, and what a hand holds is "
        f"{_length(DEFAULT_TRAINING.smallest_m)} to {_length(DEFAULT_TRAINING.largest_m)}: "
        + _mend_of_size(shape, size)
    )


def _mend_of_size(shape: ObjectShape, size: float) -> str:
    if not _fits(shape.vertices, shape):
        if size < DEFAULT_TRAINING.smallest_m:
            return "scale it to metres, as marked_vertices are"
        unit = _likeliest_unit(size, _size(shape.marked_vertices))
        return f"it seems to be in {unit}; scale it to metres, by {_UNITS[unit]:g}"
    if size < DEFAULT_TRAINING.smallest_m:
        return "scale it and marked_vertices to metres"
    sizes = (f"by {f:g} from {unit} ({_length(size * f)})" for unit, f in _UNITS.items())
    return f"scale it and marked_vertices to metres, {' or '.join(sizes)}"


def _likeliest_unit(large: float, small: float) -> str:
    """Return the unit that brings one size nearest to another."""
    return min(_UNITS, key=lambda unit: abs(np.log(large * _UNITS[unit] / max(small, 1e-12))))


def _check_spread(marks: Array, folder: Path) -> None:
    """Check that marks show every turn, which those of one line or point do not."""
    spreads = np.linalg.svd(marks - marks.mean(axis=0), compute_uv=False) / np.sqrt(len(marks))
    least = DEFAULT_TRAINING.least_mark_spread_m
    if spreads[1] >= least:
        return
    where = "are all one point" if spreads[0] < least else "lie on one line"
    raise DatasetError(
        f"{folder}: its {len(marks)} marked_vertices {where}, within {_length(least)}: mark three "
        "or more vertices of the mesh, in metres, that lie apart in two directions"
    )


def _check_distance(shape: ObjectShape, folder: Path) -> None:
    far = _far_marks(shape.vertices, shape)
    if far.any():
        raise DatasetError(
            f"{folder}: marked_vertices lie up to {_length(far.max())} from the mesh, which is "
            f"{_length(_size(shape.vertices))} long: {_mend_of_distance(shape)}"
        )
    if _marks_little(shape.vertices, shape):
        raise DatasetError(
            f"{folder}: marked_vertices cover {_length(_size(shape.marked_vertices))} of a mesh "
            f"that is {_length(_size(shape.vertices))} long: scale one of them so that both are "
            "in metres, or mark vertices that lie further apart"
        )


def _mend_of_distance(shape: ObjectShape) -> str:
    marks, vertices = shape.marked_vertices, shape.vertices
    sizes = _size(marks), _size(vertices)
    unit = _likeliest_unit(*sizes)
    scaled = sizes[0] * _UNITS[unit]
    if scaled > DEFAULT_TRAINING.clear_unit_share * sizes[1] and _fits(
        vertices / _UNITS[unit], shape
    ):
        return f"the marks seem to be in {unit}; scale them to metres, by {_UNITS[unit]:g}"
    for axes, turn in _TURNS.items():
        if _fits(vertices @ turn.T, shape):
            return f"{axes}; turn it about x so that z does, as in the marks"
    move = np.round(_middle(marks) - _middle(vertices), 3) + 0.0
    if _fits(vertices + move, shape):
        across = ", ".join(f"{value:g}" for value in move)
        return f"move the mesh by about [{across}] m, or mark vertices of it"
    return "mark vertices of the mesh, in metres and in its axes"


def _fits(vertices: Array, shape: ObjectShape) -> bool:
    return not _far_marks(vertices, shape).any() and not _marks_little(vertices, shape)


def _marks_little(vertices: Array, shape: ObjectShape) -> bool:
    """Whether the marks are so close together that they must be in other units than the mesh."""
    return _size(shape.marked_vertices) < DEFAULT_TRAINING.least_marked_share * _size(vertices)


def _far_marks(vertices: Array, shape: ObjectShape) -> Array:
    """Find the distances in metres (M,) of marks from the surface; 0 where they may be meant.

    Corners of the box around a mesh are marks that some data have, and measured markers stand out.
    """
    marks, size = shape.marked_vertices, _size(vertices)
    beyond = np.maximum(vertices.min(axis=0) - marks, marks - vertices.max(axis=0)).max(axis=1)
    most = max(DEFAULT_TRAINING.farthest_mark_m, DEFAULT_TRAINING.farthest_mark_share * size)
    distances = np.zeros(len(marks))
    for mark in np.flatnonzero(beyond > DEFAULT_TRAINING.beyond_mesh_share * size):
        distance = _distance(vertices[shape.faces], marks[mark])
        distances[mark] = distance if distance > most else 0.0
    return distances


def _distance(triangles: Array, point: Array) -> float:
    """Return the distance of a point (3,) from the nearest of triangles (F, 3, 3)."""
    points = np.broadcast_to(point, (len(triangles), 3))
    nearest = trimesh.triangles.closest_point(triangles, points)  # type: ignore[no-untyped-call]
    return float(np.linalg.norm(nearest - point, axis=1).min())


def _size(points: Array) -> float:
    """Return the longest side of the box around points (N, 3)."""
    return float(np.ptp(points, axis=0).max())


def _middle(points: Array) -> Array:
    return (points.min(axis=0) + points.max(axis=0)) / 2.0


def _length(metres: float) -> str:
    """Write a length in the unit that shows what may be wrong with it."""
    if metres >= 1.0:
        return f"{metres:.3g} m" if metres < 1000.0 else f"{metres:.0f} m"
    return f"{metres * 100.0:.3g} cm" if metres >= 0.01 else f"{metres * 1000.0:.3g} mm"
