"""Coloured triangle surfaces, built of simple solids and lit in the camera's frame."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import trimesh
from inhand_tracker.geometry.arrays import Array, Singles
from numpy.typing import ArrayLike, NDArray
from trimesh import creation

from inhand_lab.geometry.transforms import Transform, normalised

Rgb = tuple[int, int, int]
"""Red, green and blue, 0 to 255."""

AMBIENT = 0.42
"""Share of the light that comes from everywhere."""
LIGHT_IN_CAMERA = normalised([-0.35, -0.75, -0.55])
"""Direction to the light: above, to the left and on the camera's side."""


@dataclass(frozen=True)
class Surface:
    """Triangles: vertices and normals (V, 3), faces (F, 3), colours (V, 3) RGB from 0 to 255."""

    vertices: Array
    normals: Array
    faces: NDArray[np.int32]
    colours: Singles

    @cached_property
    def corners(self) -> Singles:
        """The vertices (V, 3) as they are drawn."""
        return self.vertices.astype(np.float32)

    @cached_property
    def shades(self) -> Singles:
        """Lit colours (V, 3) of a surface that is in the camera's frame."""
        return lit(self.normals, self.colours)

    def moved(self, transform: Transform) -> Surface:
        """The surface under one rigid transform."""
        return Surface(
            transform.apply(self.vertices),
            self.normals @ transform.rotation.T,
            self.faces,
            self.colours,
        )


def lit(normals: Array, colours: Singles) -> Singles:
    """Shades (V, 3) of colours (V, 3) on surfaces of these normals (V, 3) in the camera frame."""
    brightness = AMBIENT + (1.0 - AMBIENT) * np.clip(normals @ LIGHT_IN_CAMERA, 0.0, None)
    return np.asarray(colours * brightness[:, None], np.float32)


def join_surfaces(surfaces: list[Surface]) -> Surface:
    """Several surfaces as one."""
    offsets = np.cumsum([0, *(len(surface.vertices) for surface in surfaces)])
    return Surface(
        np.concatenate([surface.vertices for surface in surfaces]),
        np.concatenate([surface.normals for surface in surfaces]),
        np.concatenate(
            [surface.faces + offset for surface, offset in zip(surfaces, offsets, strict=False)]
        ).astype(np.int32),
        np.concatenate([surface.colours for surface in surfaces]),
    )


def surface_of_mesh(mesh: trimesh.Trimesh, colours: ArrayLike) -> Surface:
    """A mesh of colours (V, 3) or (3,) with sharp edges: every triangle has its own corners."""
    corners = np.asarray(mesh.faces, np.int32).ravel()
    painted = np.broadcast_to(np.asarray(colours, np.float32), (len(mesh.vertices), 3))
    return Surface(
        np.asarray(mesh.vertices, np.float64)[corners],
        np.repeat(np.asarray(mesh.face_normals, np.float64), 3, axis=0),
        np.arange(len(corners), dtype=np.int32).reshape(-1, 3),
        painted[corners],
    )


def ellipsoid(centre: ArrayLike, radii: ArrayLike, colour: Rgb, detail: int = 2) -> Surface:
    """An ellipsoid along the axes, of radii (3,) in metres."""
    sphere = creation.icosphere(subdivisions=detail)
    unit = np.asarray(sphere.vertices, np.float64)
    stretch = np.asarray(radii, np.float64)
    return Surface(
        unit * stretch + np.asarray(centre, np.float64),
        normalised(unit / stretch),
        np.asarray(sphere.faces, np.int32),
        np.tile(np.asarray(colour, np.float32), (len(unit), 1)),
    )


def limb(length: float, root_radius: float, tip_radius: float, colour: Rgb) -> Surface:
    """A round limb from the origin along z, tapering, with rounded ends."""
    sections, rings = 14, 5
    angles = 2.0 * np.pi * np.arange(sections) / sections
    latitudes = np.linspace(-0.5 * np.pi, 0.0, rings)
    profile = [(root_radius * np.cos(a), root_radius * np.sin(a), np.sin(a)) for a in latitudes]
    profile += [
        (tip_radius * np.cos(a), length + tip_radius * np.sin(a), np.sin(a))
        for a in np.linspace(0.0, 0.5 * np.pi, rings)
    ]
    radius, along, rise = np.array(profile).T
    around = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    shape = (len(along), sections, 1)
    heights, rises = (np.broadcast_to(values[:, None, None], shape) for values in (along, rise))
    vertices = np.concatenate([radius[:, None, None] * around, heights], axis=2)
    normals = np.concatenate([np.sqrt(1.0 - rises**2) * around, rises], axis=2)
    ring = sections * np.arange(len(along) - 1)[:, None]
    here = np.broadcast_to(ring + np.arange(sections), (len(ring), sections))
    beside = ring + (np.arange(sections) + 1) % sections
    lower = np.stack([here, beside, beside + sections], axis=2)
    upper = np.stack([here, beside + sections, here + sections], axis=2)
    faces = np.concatenate([lower, upper]).reshape(-1, 3)
    count = len(along) * sections
    return Surface(
        vertices.reshape(-1, 3),
        normals.reshape(-1, 3),
        faces.astype(np.int32),
        np.tile(np.asarray(colour, np.float32), (count, 1)),
    )


def block(centre: ArrayLike, size: ArrayLike, colour: Rgb) -> Surface:
    """A box along the axes, of a size (3,) in metres."""
    mesh = creation.box(extents=np.asarray(size, np.float64))
    mesh.apply_translation(np.asarray(centre, np.float64))
    return surface_of_mesh(mesh, colour)
