"""Files of triangle meshes, as other programs write them; needs the extra ``lab``.

A tracker reads no mesh, only models, so that Trimesh is loaded where one is read."""

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from inhand_runtime.errors import InhandError

from inhand_tracker.geometry.arrays import Array, Indices


def find_mesh(folder: Path) -> Path:
    """Find the only mesh of an object's folder: ``mesh.*``, in capitals or not.

    Raises InhandError where there is none, or several.
    """
    files = [path for path in folder.iterdir() if path.is_file() and _is_mesh(path)]
    meshes = sorted(path for path in files if path.stem.lower() == "mesh")
    if len(meshes) > 1:
        raise InhandError(
            f"{folder} holds {len(meshes)} meshes, {_names(meshes)}: keep the one in metres that "
            "fits marked_vertices, and move the others elsewhere"
        )
    if not meshes:
        others = f", or rename {min(files).name}" if files else ""
        raise InhandError(f"{folder} holds no mesh: add mesh.ply, mesh.obj or mesh.stl{others}")
    return meshes[0]


def read_mesh(path: Path) -> tuple[Array, Indices]:
    """Read vertices (V, 3) and faces (F, 3), without materials; raises InhandError."""
    import trimesh

    try:
        with _without_log_of_materials():
            mesh = trimesh.load_mesh(path, process=False)
        vertices = np.asarray(mesh.vertices, np.float64)
        faces = np.asarray(mesh.faces, np.int64)
    except Exception as error:  # noqa: BLE001 - a reader of foreign files may raise anything
        raise InhandError(f"{path} is no mesh that can be read: {error}") from None
    if len(faces) == 0:
        raise InhandError(
            f"{path} is no mesh that can be used: it has no triangles; export surfaces, no points, "
            "lines or solids"
        )
    if faults := np.count_nonzero(~np.isfinite(vertices).all(axis=1)):
        raise InhandError(
            f"{path} is no mesh that can be used: {faults:,} of its {len(vertices):,} vertices are "
            "no finite numbers; export it anew"
        )
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise InhandError(f"{path} is no mesh that can be used: a face has no such vertex")
    return vertices, faces


def _is_mesh(path: Path) -> bool:
    import trimesh

    return path.suffix[1:].lower() in trimesh.available_formats()


def _names(paths: list[Path]) -> str:
    return " and ".join(path.name for path in paths)


@contextmanager
def _without_log_of_materials() -> Iterator[None]:
    """Keep the reader quiet about pictures that were not copied along: only the shape is read."""
    log = logging.getLogger("trimesh")
    before = log.level
    log.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        log.setLevel(before)
