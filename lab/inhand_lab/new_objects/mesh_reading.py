"""Reads a mesh file of any program's as one mesh that training can draw."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import trimesh
from inhand_runtime.errors import InhandError, SettingsError
from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.shape.mesh_file import read_mesh

from inhand_lab.geometry.surface_distance import MeasuredSurface
from inhand_lab.new_objects.parameters import DEFAULT_MESH, DEFAULT_PROPOSAL, MeshParameters

GLTF = (".glb", ".gltf")
"""Formats that are in metres with y up, as their specification says."""


@dataclass(frozen=True)
class FileMesh:
    """A mesh as its file has it: vertices (V, 3) in the file's unit and axes, faces (F, 3).

    ``unit`` and ``up`` are what its format says of it, None where it says nothing.
    """

    vertices: Array
    faces: Indices
    unit: str | None
    up: str | None

    @property
    def sides(self) -> Array:
        """Lengths (3,) of the box around it along x, y and z, in the file's unit."""
        return np.ptp(self.vertices, axis=0)


@dataclass(frozen=True)
class ReducedMesh:
    """A mesh in metres of not too many faces, and how far it is from all of them, metres."""

    vertices: Array
    faces: Indices
    deviation_m: float


def read_file_mesh(path: Path) -> FileMesh:
    """Read all parts of a mesh file as one mesh; raises SettingsError or InhandError.

    Corners that several triangles share are one vertex, and triangles without an area are left out.
    """
    if not path.is_file():
        raise SettingsError(f"{path} is no file: name a mesh, such as mug.stl")
    formats = trimesh.available_formats()
    if path.suffix[1:].lower() not in formats:
        raise SettingsError(
            f"{path} is of no format that is read: export it as "
            f"{', '.join(sorted(formats & {'stl', 'obj', 'ply', 'glb', 'off'}))}"
        )
    vertices, faces = read_mesh(path)
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    mesh.merge_vertices(merge_tex=True, merge_norm=True)
    mesh.update_faces(mesh.nondegenerate_faces(height=0.0))
    mesh.remove_unreferenced_vertices()
    merged = np.asarray(mesh.vertices, np.float64)
    if not len(mesh.faces) or not np.ptp(merged, axis=0).max() > 0.0:
        raise InhandError(f"{path} is no mesh that can be used: its triangles have no area")
    by_format = path.suffix.lower() in GLTF
    return FileMesh(
        merged,
        np.asarray(mesh.faces, np.int64),
        "m" if by_format else None,
        "y" if by_format else None,
    )


def reduce_mesh(
    vertices: Array, faces: Indices, parameters: MeshParameters = DEFAULT_MESH
) -> ReducedMesh:
    """Reduce a mesh in metres to as many faces as training should draw.

    The deviation is the mean distance of the whole surface from the reduced one.
    """
    if len(faces) <= parameters.most_faces:
        return ReducedMesh(vertices, faces, 0.0)
    import fast_simplification

    # The method counts in single precision, so that it is given sizes of about 1.
    size = np.ptp(vertices, axis=0).max()
    points, triangles = fast_simplification.simplify(
        vertices / size, faces, target_count=parameters.most_faces
    )[:2]
    reduced = np.asarray(points, np.float64) * size
    kept = np.asarray(triangles, np.int64)
    chosen = DEFAULT_PROPOSAL
    whole = MeasuredSurface(vertices, faces, chosen.samples, chosen.neighbours)
    part = MeasuredSurface(reduced, kept, chosen.samples, chosen.neighbours)
    deviation = float(part.distances(whole.points(chosen.compared)).mean())
    return ReducedMesh(reduced, kept, deviation)
