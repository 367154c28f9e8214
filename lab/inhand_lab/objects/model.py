"""Objects of the simulated world, and how their meshes are put together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import trimesh
from inhand_tracker.geometry.arrays import Array, Bytes, Indices
from inhand_tracker.shape.shape import Symmetry
from trimesh import creation

from inhand_lab.geometry.transforms import MIRROR, normalised

TUBE_SECTIONS = 10
"""Number of corners of a tube's cross section."""
Z_TO_MINUS_Y = np.array([[1.0, 0, 0, 0], [0, 0, -1.0, 0], [0, 1.0, 0, 0], [0, 0, 0, 1.0]])
"""Homogeneous transform that lays the z axis along -y."""

RETURN_NO_DEPTH = frozenset(
    {
        "camera",
        "flute",
        "glasses",
        "golf_club",
        "magnifier",
        "phone",
        "racket",
        "vinegar_bottle",
    }
)
"""The eight of the fifteen that a depth sensor across a room does not see.

Darby et al. (2014) say that there were eight, and not which. These are made of glass, chromed or
glossy black, or finer than the pattern that is projected or matched.
"""


@dataclass(frozen=True)
class ObjectModel:
    """An object: its mesh in metres in the object's frame, and what tracking needs of it.

    ``marked_vertices`` (M, 3) are vertices of the mesh for the error score. ``symmetries`` are the
    turns that leave the object looking the same. ``colour`` (3,) and ``vertex_colours`` (V, 3) are
    RGB, 0 to 255. ``returns_depth`` is false for what a depth sensor does not see.
    """

    name: str
    mesh: trimesh.Trimesh
    vertex_colours: Bytes
    marked_vertices: Array
    symmetries: tuple[Symmetry, ...]
    colour: tuple[int, int, int]
    mirror_normal: tuple[float, float, float] = (1.0, 0.0, 0.0)
    returns_depth: bool = True

    @property
    def vertices(self) -> Array:
        """Vertices (V, 3) of the mesh, metres."""
        return np.asarray(self.mesh.vertices, float)

    @property
    def faces(self) -> Indices:
        """Indices (F, 3) of each face's vertices, counter-clockwise from outside."""
        return np.asarray(self.mesh.faces, np.int64)


def reflected(mesh: trimesh.Trimesh) -> trimesh.Trimesh:
    """The mirror image in the plane x = 0."""
    return trimesh.Trimesh(mesh.vertices * MIRROR, mesh.faces[:, ::-1], process=False)


def tube(path: Array, radius: float) -> trimesh.Trimesh:
    """A round rod along a path of points (K, 3) in metres that nowhere doubles back, closed."""
    tangents = normalised(np.gradient(path, axis=0))
    sideways = normalised(np.cross(tangents, np.cross([1.0, 0.02, 0.2], tangents)))
    angles = 2.0 * np.pi * np.arange(TUBE_SECTIONS) / TUBE_SECTIONS
    rings = path[:, None] + radius * (
        np.cos(angles)[:, None] * sideways[:, None]
        + np.sin(angles)[:, None] * np.cross(tangents, sideways)[:, None]
    )
    around = np.arange(TUBE_SECTIONS)
    beside = (around + 1) % TUBE_SECTIONS
    faces = [
        face
        for ring in TUBE_SECTIONS * np.arange(len(path) - 1)
        for face in (
            *zip(ring + around, ring + beside, ring + TUBE_SECTIONS + beside, strict=True),
            *zip(
                ring + around,
                ring + TUBE_SECTIONS + beside,
                ring + TUBE_SECTIONS + around,
                strict=True,
            ),
        )
    ]
    last = TUBE_SECTIONS * (len(path) - 1)
    faces += [(0, b + 1, b) for b in range(1, TUBE_SECTIONS - 1)]
    faces += [(last, last + b, last + b + 1) for b in range(1, TUBE_SECTIONS - 1)]
    return trimesh.Trimesh(rings.reshape(-1, 3), np.array(faces), process=False)


def turned(outline: Sequence[tuple[float, float]], sections: int) -> trimesh.Trimesh:
    """A surface of revolution about z of an outline of radii and heights in metres.

    An outline that begins and ends on the axis, from below round the outside, makes a closed solid.
    """
    return creation.revolve(np.array(outline), sections=sections)


def build_model(
    name: str,
    parts: list[tuple[trimesh.Trimesh, tuple[int, int, int]]],
    marks: list[tuple[float, float, float]],
    symmetries: tuple[Symmetry, ...] = (),
) -> ObjectModel:
    """Parts with their colours as one mesh; each mark is moved to the nearest vertex."""
    mesh = trimesh.util.concatenate([part for part, _ in parts])
    if not isinstance(mesh, trimesh.Trimesh):
        raise TypeError("parts of an object must be triangle meshes")
    vertices = np.asarray(mesh.vertices, np.float64)
    colours = np.concatenate([np.tile(colour, (len(part.vertices), 1)) for part, colour in parts])
    distances = np.linalg.norm(vertices[None] - np.array(marks)[:, None], axis=2)
    return ObjectModel(
        name,
        mesh,
        colours.astype(np.uint8),
        vertices[distances.argmin(axis=1)],
        symmetries,
        parts[0][1],
        returns_depth=name not in RETURN_NO_DEPTH,
    )
