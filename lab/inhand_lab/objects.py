"""The things in people's hands, modelled at real size.

Every object's frame has the plane x = 0 as the object's own mirror plane, so that left-handed use
is right-handed use reflected.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
import trimesh
from numpy.typing import NDArray
from trimesh import creation

from inhand_lab.transforms import MIRROR, Floats, normalised

MUG_HEIGHT = 0.096
MUG_RADIUS = 0.041
MUG_WALL = 0.004
MUG_HANDLE_REACH = 0.033
"""Mug's wall to the middle of its handle's bar."""

LENS_CENTRE = 0.033
LENS_HALF_SIZE = (0.026, 0.021)
TEMPLE_OFFSET = 0.078
TEMPLE_LENGTH = 0.14
EAR_DROP = 0.025
FRAME_COLOUR = (30, 28, 32)
LENS_COLOUR = (70, 82, 96)

BROOM_LENGTH = 1.38
"""Bristle tips to the end of the handle."""
BROOM_HALF_LENGTH = BROOM_LENGTH / 2.0
HANDLE_RADIUS = 0.0125

TUBE_SECTIONS = 10
UPRIGHT = np.array([[1.0, 0, 0, 0], [0, 0, -1.0, 0], [0, 1.0, 0, 0], [0, 0, 0, 1.0]])
"""Homogeneous transform that lays the z axis along -y."""


@dataclass(frozen=True)
class ObjectModel:
    """An object: mesh in metres in the object's frame, and what tracking needs to know of it.

    marked_vertices (M, 3) are vertices of the mesh for the error score. symmetries lists axes
    (3,) about which any rotation leaves the object looking the same. colour (3,) and
    vertex_colours (V, 3) are RGB, 0 to 255.
    """

    name: str
    mesh: trimesh.Trimesh
    vertex_colours: NDArray[np.uint8]
    marked_vertices: Floats
    symmetries: tuple[tuple[float, float, float], ...]
    colour: tuple[int, int, int]
    mirror_normal: tuple[float, float, float] = (1.0, 0.0, 0.0)

    @property
    def vertices(self) -> Floats:
        """(V, 3) metres."""
        return np.asarray(self.mesh.vertices, float)

    @property
    def faces(self) -> NDArray[np.int64]:
        """(F, 3) indices of vertices, counter-clockwise from outside."""
        return np.asarray(self.mesh.faces, np.int64)


@cache
def mug() -> ObjectModel:
    """A mug standing along z, its handle towards +y; the origin is the middle of the cup."""
    half = MUG_HEIGHT / 2.0
    outline = [
        (0.0, -half),
        (MUG_RADIUS - 0.003, -half),
        (MUG_RADIUS, -half + 0.004),
        (MUG_RADIUS, half),
        (MUG_RADIUS - MUG_WALL, half),
        (MUG_RADIUS - MUG_WALL, -half + 0.006),
        (0.0, -half + 0.006),
    ]
    cup = creation.revolve(np.array(outline), sections=40)
    reach = MUG_RADIUS - 0.002
    angles = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 13)
    loop = np.stack(
        [
            np.zeros(13),
            reach + (MUG_HANDLE_REACH + 0.002) * np.cos(angles) ** 0.7,
            0.030 * np.sin(angles),
        ],
        axis=1,
    )
    handle = _tube(loop, 0.006)
    marks = [
        (MUG_RADIUS, 0.0, half),
        (-MUG_RADIUS, 0.0, half),
        (0.0, -MUG_RADIUS, half),
        (0.0, MUG_RADIUS, half),
        (0.028, -0.028, -half),
        (-0.028, -0.028, -half),
        (0.0, MUG_RADIUS + MUG_HANDLE_REACH + 0.006, 0.0),
    ]
    return _model("mug", [(cup, (178, 40, 46)), (handle, (178, 40, 46))], marks)


@cache
def glasses() -> ObjectModel:
    """Spectacles as worn: x to the wearer's right, y forward, z up; the origin is the bridge."""
    rim = trimesh.creation.torus(1.0, 0.10, major_sections=28, minor_sections=6)
    rim.apply_scale([LENS_HALF_SIZE[0], LENS_HALF_SIZE[1], 0.026])
    lens = creation.cylinder(radius=1.0, height=0.0016, sections=28)
    lens.apply_scale([LENS_HALF_SIZE[0], LENS_HALF_SIZE[1], 1.0])
    for part in (rim, lens):
        part.apply_transform(UPRIGHT)
        part.apply_translation([LENS_CENTRE, 0.0, 0.0])
    hinge = LENS_CENTRE + 0.95 * LENS_HALF_SIZE[0]
    temple = _tube(
        np.array(
            [
                (hinge, 0.0, 0.006),
                (TEMPLE_OFFSET, -0.012, 0.008),
                (TEMPLE_OFFSET, 0.045 - TEMPLE_LENGTH, 0.004),
                (TEMPLE_OFFSET - 0.002, -TEMPLE_LENGTH, -EAR_DROP),
            ]
        ),
        0.0032,
    )
    right = [(rim, FRAME_COLOUR), (lens, LENS_COLOUR), (temple, FRAME_COLOUR)]
    left = [(_reflected(part), colour) for part, colour in right]
    arch = np.array([(-0.010, 0.001, 0.006), (0.0, 0.003, 0.009), (0.010, 0.001, 0.006)])
    parts = [*right, *left, (_tube(arch, 0.003), FRAME_COLOUR)]
    edge = LENS_CENTRE + LENS_HALF_SIZE[0]
    marks = [
        (0.0, 0.003, 0.012),
        (edge, 0.0, 0.0),
        (-edge, 0.0, 0.0),
        (LENS_CENTRE, 0.0, -LENS_HALF_SIZE[1]),
        (-LENS_CENTRE, 0.0, -LENS_HALF_SIZE[1]),
        (TEMPLE_OFFSET, -TEMPLE_LENGTH, -EAR_DROP),
        (-TEMPLE_OFFSET, -TEMPLE_LENGTH, -EAR_DROP),
    ]
    return _model("glasses", parts, marks)


@cache
def broom() -> ObjectModel:
    """A broom standing along z on its bristles, wide along x; the origin is the middle of it."""
    foot = -BROOM_HALF_LENGTH
    handle = creation.cylinder(
        radius=HANDLE_RADIUS,
        segment=[(0.0, 0.0, foot + 0.11), (0.0, 0.0, BROOM_HALF_LENGTH)],
        sections=16,
    )
    head = creation.box(extents=(0.28, 0.05, 0.05))
    head.apply_translation([0.0, 0.0, foot + 0.095])
    bristles = trimesh.convex.convex_hull(
        np.array(
            [
                (x * wide, y * deep, z)
                for wide, deep, z in ((0.155, 0.035, foot), (0.135, 0.022, foot + 0.07))
                for x in (-1.0, 1.0)
                for y in (-1.0, 1.0)
            ]
        )
    )
    marks = [
        (HANDLE_RADIUS, 0.0, BROOM_HALF_LENGTH),
        (-HANDLE_RADIUS, 0.0, BROOM_HALF_LENGTH),
        (0.14, 0.025, foot + 0.12),
        (-0.14, 0.025, foot + 0.12),
        (0.155, 0.035, foot),
        (-0.155, 0.035, foot),
        (0.155, -0.035, foot),
        (-0.155, -0.035, foot),
    ]
    parts = [(handle, (196, 150, 84)), (head, (60, 96, 168)), (bristles, (214, 186, 92))]
    return _model("broom", parts, marks)


def _reflected(mesh: trimesh.Trimesh) -> trimesh.Trimesh:
    """The mirror image in the plane x = 0."""
    return trimesh.Trimesh(mesh.vertices * MIRROR, mesh.faces[:, ::-1], process=False)


def _tube(path: Floats, radius: float) -> trimesh.Trimesh:
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


def _model(
    name: str,
    parts: list[tuple[trimesh.Trimesh, tuple[int, int, int]]],
    marks: list[tuple[float, float, float]],
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
        symmetries=(),
        colour=parts[0][1],
    )
