"""An object's shape, and the folder ``objects/NAME/`` that keeps it in a dataset.

``mesh.ply`` (or any other ``mesh.*`` that trimesh reads) and ``object.toml``: the marked vertices
of the error score, the object's own plane of symmetry, and its axes of rotational symmetry.
"""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from inhand_runtime.errors import InhandError
from inhand_schemas.keys import require_name

from inhand_tracker.geometry.arrays import Array, Indices


@dataclass(frozen=True)
class Symmetry:
    """Turns about ``axis`` (3,) through ``centre`` (3,) that leave the object as it is.

    ``order`` n means turns by 2π/n; 0 means by any angle.
    """

    axis: tuple[float, float, float]
    centre: tuple[float, float, float] = (0.0, 0.0, 0.0)
    order: int = 0


@dataclass(frozen=True)
class ObjectShape:
    """A triangle mesh in metres in the object's frame.

    ``vertices`` (V, 3), ``faces`` (F, 3) indices, ``marked_vertices`` (M, 3) points,
    ``mirror_normal`` (3,) the unit normal of the plane of symmetry through the origin.
    """

    name: str
    vertices: Array
    faces: Indices
    marked_vertices: Array
    mirror_normal: Array
    symmetries: tuple[Symmetry, ...] = ()


def save_shape(shape: ObjectShape, folder: Path) -> None:
    """Write ``mesh.ply`` and ``object.toml`` to a folder, which is made if need be."""
    folder.mkdir(parents=True, exist_ok=True)
    mesh = trimesh.Trimesh(shape.vertices, shape.faces, process=False)
    mesh.export(folder / "mesh.ply")
    lines = [
        f'name = "{shape.name}"',
        f"mirror_normal = {_toml_vector(shape.mirror_normal)}",
        "marked_vertices = [",
        *(f"    {_toml_vector(vertex)}," for vertex in shape.marked_vertices),
        "]",
    ]
    for symmetry in shape.symmetries:
        lines += [
            "",
            "[[symmetries]]",
            f"axis = {_toml_vector(symmetry.axis)}",
            f"centre = {_toml_vector(symmetry.centre)}",
            f"order = {symmetry.order}",
        ]
    (folder / "object.toml").write_text("\n".join(lines) + "\n", encoding="utf-8")


def load_shape(folder: Path) -> ObjectShape:
    """Read an object's folder; raises InhandError with the mend."""
    description = folder / "object.toml"
    try:
        values = tomllib.loads(description.read_text(encoding="utf-8"))
    except OSError as error:
        raise InhandError(f"cannot read {description}: {error.strerror}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InhandError(f"{description} is no TOML: {error}") from None
    vertices, faces = _load_mesh(folder)
    try:
        name = str(values.get("name", folder.name))
        require_name("object", name)
        marked = _vectors(values.get("marked_vertices", ()))
        normal = _vectors([values.get("mirror_normal", (1.0, 0.0, 0.0))])[0]
        symmetries = tuple(_symmetry(entry) for entry in values.get("symmetries", ()))
        if not np.linalg.norm(normal) > 0.0:
            raise ValueError("mirror_normal has no length")
    except (ValueError, TypeError, KeyError, OverflowError) as error:
        raise InhandError(f"{description}: {error}") from None
    if len(marked) < 3:
        raise InhandError(
            f"{description} marks {len(marked)} vertices: the error score needs 3 or more; "
            "write marked_vertices = [[x, y, z], …] in metres"
        )
    return ObjectShape(name, vertices, faces, marked, normal / np.linalg.norm(normal), symmetries)


def _load_mesh(folder: Path) -> tuple[Array, Indices]:
    formats = trimesh.available_formats()
    found = sorted(path for path in folder.glob("mesh.*") if path.suffix[1:] in formats)
    if not found:
        raise InhandError(f"{folder} holds no mesh: add mesh.ply, mesh.obj or mesh.stl")
    try:
        mesh = trimesh.load_mesh(found[0], process=False)
        vertices = np.asarray(mesh.vertices, np.float64)
        faces = np.asarray(mesh.faces, np.int64)
    except Exception as error:  # noqa: BLE001 - a reader of foreign files may raise anything
        raise InhandError(f"{found[0]} is no mesh that can be read: {error}") from None
    if len(faces) == 0 or not np.isfinite(vertices).all():
        raise InhandError(f"{found[0]} is no mesh that can be used: it has no finite triangles")
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise InhandError(f"{found[0]} is no mesh that can be used: a face has no such vertex")
    return vertices, faces


def _symmetry(entry: Mapping[str, Any]) -> Symmetry:
    axis, centre = _vectors([entry["axis"], entry.get("centre", (0.0, 0.0, 0.0))]).tolist()
    return Symmetry(tuple(axis), tuple(centre), int(entry.get("order", 0)))


def _vectors(values: Any) -> Array:
    array = np.asarray(values, float)
    if array.size and array.shape[1:] != (3,):
        raise ValueError("a vector is three numbers, [x, y, z]")
    array = array.reshape(-1, 3)
    if not np.isfinite(array).all():
        raise ValueError("a vector holds a number that is not finite")
    return array


def _toml_vector(vector: Any) -> str:
    return "[" + ", ".join(repr(float(value)) for value in vector) + "]"
