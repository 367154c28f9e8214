"""Objects as a camera sees them at their poses, drawn of their meshes."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from tempfile import NamedTemporaryFile

import numpy as np
from inhand_lab.geometry.canvas import Canvas, draw_triangles
from inhand_runtime.errors import InhandError
from inhand_schemas.messages import CameraInfo, Pose
from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.geometry.camera import Intrinsics, intrinsics_of
from inhand_tracker.geometry.rotations import rotate
from inhand_tracker.shape.mesh_file import find_mesh, read_mesh
from inhand_tracker.shape.shape import Symmetry, load_shape

_DRAWN = 1
"""Label of the object's pixels."""


@dataclass(frozen=True)
class Mesh:
    """Triangles in the object's frame, in metres: vertices (V, 3), faces (F, 3), and the turns that
    leave the object as it is, none where nothing says them."""

    vertices: Array
    faces: Indices
    symmetries: tuple[Symmetry, ...] = ()


class Meshes:
    """The meshes of objects, from a folder with one for each, as a dataset's ``objects``, or else
    those that are attached to the recordings, PLY by the objects' names."""

    def __init__(self, folder: Path | None, attached: Mapping[str, bytes]) -> None:
        self._folder, self._attached = folder, attached
        self.mesh = lru_cache(maxsize=None)(self._read)

    def _read(self, name: str) -> Mesh:
        """Read an object's mesh; raises InhandError where there is none."""
        if self._folder is None and name in self._attached:
            with NamedTemporaryFile(suffix=".ply") as file:
                file.write(self._attached[name])
                file.flush()
                return Mesh(*read_mesh(Path(file.name)))
        if self._folder is None:
            raise InhandError(
                f"the shape of {name} is not known: --objects FOLDER with {name}/mesh.ply, as a "
                "dataset's objects"
            )
        folder = self._folder / name
        if not folder.is_dir():
            raise InhandError(f"{self._folder} has no folder {name}: add {name}/mesh.ply")
        if (folder / "object.toml").is_file():
            shape = load_shape(folder)
            return Mesh(shape.vertices, shape.faces, shape.symmetries)
        return Mesh(*read_mesh(find_mesh(folder)))


def lens_of(info: CameraInfo, width: int, height: int) -> Intrinsics:
    """Return how the camera sees in an image of a size."""
    return intrinsics_of(info).scaled_to(width, height)


def draw_placed(mesh: Mesh, camera_from_object: Pose, lens: Intrinsics) -> Canvas:
    """Draw an object alone, whichever way its triangles are wound."""
    rotation = np.array(camera_from_object.rotation)
    placed = rotate(rotation, mesh.vertices) + np.array(camera_from_object.translation)
    canvas = Canvas.blank(lens)
    both_sides = np.concatenate([mesh.faces, mesh.faces[:, ::-1]]).astype(np.int32)
    vertices = placed.astype(np.float32)
    draw_triangles(canvas, lens, vertices, both_sides, np.zeros_like(vertices), _DRAWN)
    return canvas
