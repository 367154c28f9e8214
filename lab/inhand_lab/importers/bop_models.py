"""Reads the object models of BOP data sets: meshes in millimetres, and their symmetries.

``models/obj_000001.ply`` with ``models/models_info.json`` (optional): ``diameter``,
``symmetries_discrete`` (4 × 4 matrices, row by row) and ``symmetries_continuous`` (an axis through
an offset).
"""

import math
from collections import Counter
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from inhand_runtime.errors import InhandError
from inhand_schemas.errors import KeyFormatError
from inhand_schemas.keys import require_name
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.shape.mesh_file import read_mesh
from inhand_tracker.shape.shape import ObjectShape, Symmetry

from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.importers.parameters import DEFAULT_IMPORT
from inhand_lab.importers.shapes import shape_of_mesh

INFO_FILE = "models_info.json"
M_PER_MM = 0.001


class _ContinuousSymmetry(msgspec.Struct, frozen=True):
    axis: tuple[float, float, float]
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)


class _ModelInfo(msgspec.Struct, frozen=True):
    name: str | None = None
    diameter: float | None = None
    symmetries_discrete: tuple[tuple[float, ...], ...] = ()
    symmetries_continuous: tuple[_ContinuousSymmetry, ...] = ()


def bop_object_name(object_id: int) -> str:
    """Return the name of an object, ``obj_000001`` of 1, as its mesh is named."""
    return f"obj_{object_id:06}"


def find_models_folder(scene: Path) -> Path | None:
    """Return the folder of models that is nearest above a scene's folder; None without any.

    It is ``models``, or else the first ``models_…``, those for evaluation (``…_eval``, coarser
    meshes) last.
    """
    for parent in scene.resolve().parents[:3]:
        folders = [path for path in parent.glob("models*") if any(path.glob("obj_*.ply"))]
        if folders:
            return min(folders, key=lambda path: (path.name.endswith("_eval"), path.name))
    return None


def read_bop_shape(models: Path, object_id: int) -> ObjectShape | None:
    """Read an object's mesh and symmetries, in metres; None where it has no mesh.

    Raises DatasetError for a mesh or a symmetry that cannot be used.
    """
    name = bop_object_name(object_id)
    path = models / f"{name}.ply"
    if not path.is_file():
        return None
    info = _read_info(models / INFO_FILE).get(object_id, _ModelInfo())
    raw = shape_of_mesh(name, path)
    _check_diameter(path, raw.vertices, info.diameter)
    try:
        symmetries = _symmetries(info)
    except ValueError as error:
        raise DatasetError(f"{models / INFO_FILE}, object {object_id}: {error}") from None
    return replace(
        raw,
        vertices=raw.vertices * M_PER_MM,
        marked_vertices=raw.marked_vertices * M_PER_MM,
        symmetries=symmetries,
    )


def read_bop_mesh(models: Path, object_id: int) -> tuple[Array, Indices] | None:
    """Read an object's vertices (V, 3) in metres and faces (F, 3); None where it has no mesh.

    Raises DatasetError for a mesh that cannot be used, whatever its symmetries are.
    """
    path = models / f"{bop_object_name(object_id)}.ply"
    if not path.is_file():
        return None
    try:
        vertices, faces = read_mesh(path)
    except InhandError as error:
        raise DatasetError(str(error)) from None
    info = _read_info(models / INFO_FILE).get(object_id, _ModelInfo())
    _check_diameter(path, vertices, info.diameter)
    return vertices * M_PER_MM, faces


def read_bop_names(models: Path) -> dict[int, str]:
    """Return the names of objects, by their numbers: those that our exports write beside the
    benchmark's own fields, without any that no key can have, or that several have."""
    infos = _read_info(models / INFO_FILE)
    names = {number: info.name for number, info in infos.items() if info.name is not None}
    counts = Counter(names.values())
    return {number: name for number, name in names.items() if _is_name(name) and counts[name] == 1}


def _is_name(text: str) -> bool:
    try:
        require_name("object", text)
    except KeyFormatError:
        return False
    return True


def discrete_symmetries(matrices: Iterable[Array]) -> tuple[Symmetry, ...]:
    """Return the axes (in metres) of turns that are given as matrices (4, 4) in millimetres.

    Turns about one axis are one symmetry, of the order that they make together; an axis whose
    turns are products of the others' is left out. Raises ValueError for what is no turn about an
    axis by a part of a whole turn.
    """
    orders: list[tuple[Array, Array, int]] = []
    for matrix in matrices:
        turn = _axis_of(matrix)
        if turn is None:
            continue
        axis, centre, order = turn
        for index, (other, place, known) in enumerate(orders):
            if abs(float(axis @ other)) > 1.0 - DEFAULT_IMPORT.unit_tolerance:
                orders[index] = (other, place, math.lcm(known, order))
                break
        else:
            orders.append((axis, centre, order))
    kept: list[Symmetry] = []
    products = [np.eye(4)[0]]
    for axis, centre, order in sorted(orders, key=lambda one: -one[2]):
        turns = [rotations.from_vector(axis * (2.0 * np.pi * k / order)) for k in range(order)]
        if all(any(_same(turn, known) for known in products) for turn in turns):
            continue
        products = [rotations.multiply(known, turn) for known in products for turn in turns]
        kept.append(Symmetry(_vector(axis), _vector(centre * M_PER_MM), order))
    return tuple(kept)


def _symmetries(info: _ModelInfo) -> tuple[Symmetry, ...]:
    if any(len(matrix) != 16 for matrix in info.symmetries_discrete):
        raise ValueError("a discrete symmetry has not 4 × 4 numbers")
    continuous = []
    for one in info.symmetries_continuous:
        axis = np.array(one.axis)
        if not np.linalg.norm(axis) > 0.0:
            raise ValueError("the axis of a continuous symmetry has no length")
        centre = np.array(one.offset) * M_PER_MM
        continuous.append(Symmetry(_vector(axis), _vector(centre), 0))
    discrete = discrete_symmetries(
        np.array(matrix).reshape(4, 4) for matrix in info.symmetries_discrete
    )
    return (*continuous, *discrete)


def _axis_of(matrix: Array) -> tuple[Array, Array, int] | None:
    """The axis (3,), a point (3,) on it and the order of a turn; None of one that turns nothing."""
    rotation, shift = matrix[:3, :3], matrix[:3, 3]
    off = np.abs(rotation @ rotation.T - np.eye(3)).max()
    if not off < DEFAULT_IMPORT.symmetry_tolerance or np.linalg.det(rotation) < 0.0:
        raise ValueError("a discrete symmetry holds no rotation")
    vector = rotations.to_vector(rotations.from_matrix(rotation))
    angle = float(np.linalg.norm(vector))
    if angle < DEFAULT_IMPORT.symmetry_tolerance:
        return None
    order = _order_of(angle)
    axis = vector / angle
    if abs(float(axis @ shift)) > DEFAULT_IMPORT.most_symmetry_shift_mm:
        raise ValueError("a discrete symmetry shifts the object along the axis that it turns about")
    # The point nearest to the origin that stays where it is.
    centre = np.linalg.pinv(np.eye(3) - rotation, rcond=0.1) @ shift
    return axis, centre, order


def _order_of(angle: float) -> int:
    for order in range(2, DEFAULT_IMPORT.highest_order + 1):
        turns = order * angle / (2.0 * np.pi)
        if abs(turns - round(turns)) * 2.0 * np.pi < DEFAULT_IMPORT.symmetry_tolerance * order:
            return order
    raise ValueError(
        f"a discrete symmetry turns by {np.degrees(angle):.1f}°, and no number of such turns up "
        f"to {DEFAULT_IMPORT.highest_order} is a whole one"
    )


def _same(one: Array, other: Array) -> bool:
    return abs(float(one @ other)) > 1.0 - DEFAULT_IMPORT.unit_tolerance


def _vector(values: Array) -> tuple[float, float, float]:
    x, y, z = values.tolist()
    return x, y, z


def _check_diameter(path: Path, vertices: Array, diameter: float | None) -> None:
    """Raise DatasetError for a mesh in another unit than its description."""
    diagonal = float(np.linalg.norm(np.ptp(vertices, axis=0)))
    # The box's diagonal is between the diameter and √3 times it.
    if diameter is not None and not diameter / 2.0 < diagonal < 4.0 * diameter:
        raise DatasetError(
            f"{path} is {diagonal:g} long from corner to corner, and {INFO_FILE} says that its "
            f"diameter is {diameter:g}: both are millimetres in BOP"
        )


def _read_info(path: Path) -> dict[int, _ModelInfo]:
    if not path.is_file():
        return {}
    return read_bop_json(path, dict[int, _ModelInfo])


def read_bop_json(path: Path, kind: type[Any]) -> Any:
    """Read a JSON file of BOP as that type; raises DatasetError."""
    try:
        return msgspec.json.decode(path.read_bytes(), type=kind)
    except OSError as error:
        raise DatasetError(f"cannot read {path}: {error.strerror}") from None
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise DatasetError(f"{path} is not as BOP has it: {error}") from None
