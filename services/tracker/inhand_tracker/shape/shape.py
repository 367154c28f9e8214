"""An object's shape, and the folder ``objects/NAME/`` that keeps it in a dataset.

``mesh.ply`` (or one other ``mesh.*`` that trimesh reads) and ``object.toml``: the marked vertices
of the error score, the object's own plane of symmetry, and its axes of rotational symmetry.
"""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from inhand_runtime.errors import InhandError
from inhand_runtime.settings_errors import ENCODING, suggestion
from inhand_runtime.wording import counted
from inhand_schemas.keys import require_name

from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.shape.mesh_file import find_mesh, read_mesh

_KEYS = ("name", "mirror_normal", "marked_vertices", "symmetries")
_SYMMETRY_KEYS = ("axis", "centre", "order")
_UNIT_KEYS = ("unit", "units", "scale", "scaling")


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
    """Write ``mesh.ply`` and ``object.toml`` to a folder, which is made if need be.

    Needs the extra ``lab``.
    """
    import trimesh

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
        values = tomllib.loads(description.read_text(encoding=ENCODING))
    except OSError as error:
        raise InhandError(f"cannot read {description}: {error.strerror}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InhandError(f"{description} is no TOML: {error}") from None
    try:
        _require_keys(values, _KEYS)
        name = str(values.get("name", folder.name))
        require_name("object", name)
        marked = _vectors(values.get("marked_vertices", ()))
        normal = _vectors([values.get("mirror_normal", (1.0, 0.0, 0.0))])[0]
        symmetries = tuple(_symmetry(entry) for entry in values.get("symmetries", ()))
        if not np.linalg.norm(normal) > 0.0:
            raise ValueError("mirror_normal has no length")
    except (ValueError, TypeError, OverflowError) as error:
        raise InhandError(f"{description}: {error}") from None
    if len(marked) < 3:
        raise InhandError(
            f"{description} marks {counted(len(marked), 'vertex', 'vertices')}: the "
            "error score needs 3 or more; write marked_vertices = [[x, y, z], …] in metres"
        )
    vertices, faces = read_mesh(find_mesh(folder))
    return ObjectShape(name, vertices, faces, marked, normal / np.linalg.norm(normal), symmetries)


def _require_keys(values: Mapping[str, Any], keys: tuple[str, ...], owner: str = "") -> None:
    for key in values:
        if key.lower() in _UNIT_KEYS:
            raise ValueError(
                f"unknown key {owner}{key}: mesh and marked_vertices are in metres; scale them, "
                "and take the key out"
            )
        if key not in keys:
            raise ValueError(f"unknown key {owner}{key}" + suggestion(key, keys))


def _symmetry(entry: Any) -> Symmetry:
    if not isinstance(entry, Mapping):
        raise TypeError("symmetries are tables: write [[symmetries]], and axis below it")
    _require_keys(entry, _SYMMETRY_KEYS, "symmetries.")
    if "axis" not in entry:
        raise ValueError("a symmetry lacks its axis: write axis = [x, y, z]")
    axis, centre = _vectors([entry["axis"], entry.get("centre", (0.0, 0.0, 0.0))])
    if not np.linalg.norm(axis) > 0.0:
        raise ValueError("symmetries.axis has no length: write a direction, such as [0, 0, 1]")
    order = entry.get("order", 0)
    if isinstance(order, bool) or not isinstance(order, int | float) or order < 0 or order % 1:
        raise ValueError(
            f"symmetries.order is {order!r}: write a whole number n for turns by 2π/n, or 0 for "
            "turns by any angle"
        )
    return Symmetry(tuple(axis.tolist()), tuple(centre.tolist()), int(order))


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
