"""A shoe."""

from __future__ import annotations

from functools import cache

import numpy as np
import trimesh
from inhand_tracker.geometry.arrays import Array
from numpy.typing import ArrayLike

from inhand_lab.objects.model import ObjectModel, build_model

SHOE_LENGTH = 0.29
HEEL_BEHIND = 0.078
"""Distance of the heel's end behind the origin, which is on the sole under the ankle."""
SOLE_THICKNESS = 0.024
COLLAR_HEIGHT = 0.086
TAB_HEIGHT = 0.100
"""Height of the tab at the heel by which the shoe is held."""
TOE = SHOE_LENGTH - HEEL_BEHIND

LAST = np.array(
    [
        (-HEEL_BEHIND, 0.004, 0.090),
        (-0.070, 0.028, 0.092),
        (-0.030, 0.038, 0.088),
        (0.010, 0.038, 0.084),
        (0.050, 0.041, 0.090),
        (0.085, 0.046, 0.074),
        (0.130, 0.050, 0.058),
        (0.170, 0.046, 0.050),
        (0.198, 0.034, 0.046),
        (TOE, 0.010, 0.040),
    ]
)
"""Cross sections from heel to toe: place along y, half width, height; metres."""
OPEN = 3
"""Index of the last section that is open above; from there to the toe they close over the foot."""
AROUND = 17
"""Number of vertices around a section."""


@cache
def shoe() -> ObjectModel:
    """A shoe on the floor: y to the toe, z up, the origin on the sole under the ankle.

    It is taken as its own mirror image, so that a shoe for the left foot is this one.
    """
    outline = LAST[:, :2] * (1.0, 1.06)
    edge = [(side * half, y) for y, half in outline for side in (-1.0, 1.0)]
    sole = trimesh.convex.convex_hull(
        np.array([(x, y, z) for x, y in edge for z in (0.0, SOLE_THICKNESS)])
    )
    upper = _upper()
    lining = trimesh.Trimesh(
        upper.vertices * (0.94, 0.97, 1.0), upper.faces[:, ::-1], process=False
    )
    tab = trimesh.creation.box(extents=(0.020, 0.006, 0.030))
    tab.apply_translation([0.0, -0.072, TAB_HEIGHT - 0.015])
    marks = [
        (0.0, -0.075, TAB_HEIGHT),
        (0.0, -HEEL_BEHIND, 0.0),
        (0.0, TOE, 0.0),
        (0.053, 0.130, 0.0),
        (-0.053, 0.130, 0.0),
        (0.038, -0.030, COLLAR_HEIGHT),
        (-0.038, -0.030, COLLAR_HEIGHT),
        (0.0, 0.045, 0.088),
    ]
    parts = [
        (upper, (176, 44, 40)),
        (sole, (236, 234, 226)),
        (lining, (60, 56, 58)),
        (tab, (30, 30, 34)),
    ]
    return build_model("shoe", parts, marks)


def _upper() -> trimesh.Trimesh:
    """A sheet over the last from one edge of the opening under the foot to the other."""
    rings = []
    for number, (y, half, height) in enumerate(LAST):
        gap = 0.85 if 0 < number <= OPEN else 0.0
        angle = np.linspace(0.5 * np.pi + gap, 2.5 * np.pi - gap, AROUND)
        x = half * _squared(np.cos(angle))
        z = _squared(np.sin(angle)) / _squared(np.cos(gap))
        low = 0.5 * SOLE_THICKNESS
        rings.append(np.stack([x, np.full(AROUND, y), low + (height - low) * (0.5 + 0.5 * z)], 1))
    corner = (AROUND * np.arange(len(LAST) - 1)[:, None] + np.arange(AROUND - 1)).ravel()
    faces = [
        (corner, corner + AROUND, corner + 1),
        (corner + 1, corner + AROUND, corner + AROUND + 1),
    ]
    triangles = np.concatenate([np.stack(face, axis=1) for face in faces])
    return trimesh.Trimesh(np.concatenate(rings), triangles, process=False)


def _squared(circle: ArrayLike) -> Array:
    """A circle's coordinate, -1 to 1, pushed towards a rounded square's."""
    values = np.asarray(circle, float)
    return np.asarray(np.sign(values) * np.abs(values) ** 0.65)
