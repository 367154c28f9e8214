"""A claw hammer."""

from __future__ import annotations

from functools import cache

import numpy as np
import trimesh
from trimesh import creation

from inhand_lab.objects.model import ObjectModel, build_model

HAMMER_LENGTH = 0.33
HAMMER_HALF_LENGTH = HAMMER_LENGTH / 2.0
HEAD_HEIGHT = HAMMER_HALF_LENGTH - 0.016
"""Height of the striking face's axis along the handle."""
FACE_REACH = 0.062
"""Distance from the handle's axis to the striking face."""
FACE_RADIUS = 0.0135
HANDLE_HALF_SIZE = (0.011, 0.016)
STEEL, RUBBER, ASH = (122, 126, 134), (34, 36, 40), (202, 164, 104)


@cache
def hammer() -> ObjectModel:
    """A hammer with its handle along z, striking towards +y; the origin is its middle."""
    high = HEAD_HEIGHT
    end, top = -HAMMER_HALF_LENGTH, HAMMER_HALF_LENGTH
    neck = creation.cylinder(
        radius=0.0105, segment=np.array([(0, 0.016, high), (0, 0.046, high)]), sections=16
    )
    face = creation.cylinder(
        radius=FACE_RADIUS,
        segment=np.array([(0, 0.044, high), (0, FACE_REACH, high)]),
        sections=20,
    )
    parts = [
        (face, STEEL),
        (neck, STEEL),
        (_bar((0.0, high, 0.014, 0.016), (0.018, high, 0.012, 0.012)), STEEL),
        (_bar((0.002, high, 0.013, 0.016), (-0.040, high - 0.010, 0.017, 0.007)), STEEL),
        (_bar((-0.038, high - 0.009, 0.017, 0.007), (-0.074, high - 0.030, 0.014, 0.002)), STEEL),
        (_post(end + 0.115, top, (0.010, 0.014)), ASH),
        (_post(end, end + 0.120, HANDLE_HALF_SIZE), RUBBER),
    ]
    marks = [
        (0.0, FACE_REACH, high + FACE_RADIUS),
        (0.0, FACE_REACH, high - FACE_RADIUS),
        (0.014, -0.074, high - 0.030),
        (-0.014, -0.074, high - 0.030),
        (0.0, 0.0, top),
        (HANDLE_HALF_SIZE[0], 0.0, end),
        (-HANDLE_HALF_SIZE[0], 0.0, end),
    ]
    return build_model("hammer", parts, marks)


def _post(bottom: float, top: float, half_size: tuple[float, float]) -> trimesh.Trimesh:
    """An oval rod along z."""
    rod = creation.cylinder(radius=1.0, height=top - bottom, sections=16)
    rod.apply_scale([*half_size, 1.0])
    rod.apply_translation([0.0, 0.0, 0.5 * (bottom + top)])
    return rod


def _bar(
    first: tuple[float, float, float, float], second: tuple[float, float, float, float]
) -> trimesh.Trimesh:
    """A wedge between two rectangles square to y, each (y, z, half width, half height)."""
    corners = [
        (x * wide, y, z + up * high)
        for y, z, wide, high in (first, second)
        for x in (-1.0, 1.0)
        for up in (-1.0, 1.0)
    ]
    return trimesh.convex.convex_hull(np.array(corners))
