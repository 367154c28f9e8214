"""Meshes of the objects that trackers of this host follow, out of their models.

A model is a zip of NumPy's arrays. What is needed of it is read without NumPy, which a recorder has
no other use for; a service that has reads the same bytes as arrays.
"""

import ast
import json
import struct
import zipfile
from array import array
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from inhand_runtime.errors import InhandError

MOST_BYTES = 64 << 20
"""Bytes of an array of a mesh at the most."""
_MAGIC = b"\x93NUMPY\x01\x00"


class MeshError(InhandError):
    """A model of which no mesh can be read."""


@dataclass(frozen=True)
class ObjectMesh:
    """An object's name, the interaction that its model was learned from, and its mesh in metres.

    ``vertices`` are rows of three little-endian float64, ``faces`` of three int64.
    """

    name: str
    interaction: str
    vertices: bytes
    faces: bytes

    @property
    def ply(self) -> bytes:
        """The mesh as a PLY file."""
        return _ply(self.vertices, self.faces)


def mesh_of_model(path: Path) -> ObjectMesh:
    """Return the object that a model file is of; raises MeshError."""
    try:
        with zipfile.ZipFile(path) as model:
            said = json.loads(_array(model, "model")[1].decode("utf-32-le").rstrip("\0"))
            name, interaction = said["object"], said["interaction"]
            vertices = _table(model, "shape.vertices", "<f8")
            faces = _table(model, "shape.faces", "<i8")
    except (OSError, zipfile.BadZipFile, ValueError, LookupError, SyntaxError, TypeError) as error:
        raise MeshError(f"no mesh can be read from {path}: {error}") from None
    return ObjectMesh(str(name), str(interaction), vertices, faces)


def model_files(trackers: Mapping[str, Mapping[str, Any]], folder: Path) -> tuple[Path, ...]:
    """Return the models that tables ``[tracker.NAME]`` of a settings file in a folder name."""
    names: list[Any] = []
    for table in trackers.values():
        several = table.get("models", ())
        names += [table.get("model"), *(several if isinstance(several, list | tuple) else ())]
    return tuple(dict.fromkeys(folder / name for name in names if isinstance(name, str)))


def _array(model: zipfile.ZipFile, name: str) -> tuple[dict[str, Any], bytes]:
    """The description and the bytes of an array; raises ValueError, LookupError and others."""
    info = model.getinfo(f"{name}.npy")
    if info.file_size > MOST_BYTES:
        raise ValueError(f"{name} is too large")
    data = model.read(info)
    if not data.startswith(_MAGIC):
        raise ValueError(f"{name} is no array of NumPy's")
    start = len(_MAGIC) + 2 + struct.unpack_from("<H", data, len(_MAGIC))[0]
    head: dict[str, Any] = ast.literal_eval(data[len(_MAGIC) + 2 : start].decode("latin-1"))
    return head, data[start:]


def _table(model: zipfile.ZipFile, name: str, kind: str) -> bytes:
    """The bytes of an array of three columns, row by row."""
    head, data = _array(model, name)
    rows, columns = head["shape"]
    if head["descr"] != kind or head["fortran_order"] or columns != 3 or len(data) != 24 * rows:
        raise ValueError(f"{name} is no table of three columns of {kind}")
    return data


def _ply(vertices: bytes, faces: bytes) -> bytes:
    numbers = array("q", faces)
    rows = len(numbers) // 3
    head = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(vertices) // 24}\n"
        "property double x\nproperty double y\nproperty double z\n"
        f"element face {rows}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    row = struct.Struct("<Biii")
    body = b"".join(row.pack(3, *numbers[3 * i : 3 * i + 3]) for i in range(rows))
    return head.encode() + vertices + body
