"""A transverse flute."""

from __future__ import annotations

from functools import cache

import numpy as np
import trimesh
from trimesh import creation

from inhand_lab.objects.model import ObjectModel, build_model, reflected

FLUTE_HALF_LENGTH = 0.335
TUBE_RADIUS = 0.0095
EMBOUCHURE = -0.268
"""Place along the tube at which it is blown."""
KEYS = (
    *(-0.128, -0.105, -0.083, -0.061, -0.039, -0.017, 0.022, 0.044, 0.066),
    *(0.089, 0.112, 0.136, 0.160, 0.205, 0.230, 0.256),
)
"""Places of the key cups along the tube."""
SILVER, SHADE, HOLE = (206, 208, 214), (168, 170, 178), (40, 40, 44)


@cache
def flute() -> ObjectModel:
    """A flute along y, its foot at +y, lip plate and keys at +z; the origin is its middle."""
    plate = creation.icosphere(subdivisions=2)
    plate.apply_scale([0.015, 0.020, 0.0065])
    plate.apply_translation([0.0, EMBOUCHURE, TUBE_RADIUS - 0.003])
    keys = [(_upright(y, 0.0080, 0.010, 0.0155), SHADE) for y in KEYS]
    rail = _along(-0.145, 0.275, 0.0022)
    rail.apply_translation([0.0085, 0.0, 0.0085])
    parts = [
        (_along(-FLUTE_HALF_LENGTH, FLUTE_HALF_LENGTH, TUBE_RADIUS), SILVER),
        (_along(-FLUTE_HALF_LENGTH, -FLUTE_HALF_LENGTH + 0.014, 0.0120), SHADE),
        (_along(-0.185, -0.155, 0.0115), SHADE),
        (_along(0.185, 0.192, 0.0115), SHADE),
        (plate, SILVER),
        (_upright(EMBOUCHURE, 0.0055, 0.012, 0.0135), HOLE),
        *keys,
        (rail, SHADE),
        (reflected(rail), SHADE),
    ]
    high = TUBE_RADIUS + 0.006
    marks = [
        (0.0, -FLUTE_HALF_LENGTH, 0.0),
        (0.0, FLUTE_HALF_LENGTH, 0.0),
        (0.015, EMBOUCHURE, TUBE_RADIUS - 0.003),
        (-0.015, EMBOUCHURE, TUBE_RADIUS - 0.003),
        (0.0, KEYS[0], high),
        (0.0, KEYS[-1], high),
        (0.0, 0.0, -TUBE_RADIUS),
    ]
    return build_model("flute", parts, marks)


def _along(start: float, end: float, radius: float) -> trimesh.Trimesh:
    """A cylinder about the tube's axis."""
    segment = np.array([(0.0, start, 0.0), (0.0, end, 0.0)])
    return creation.cylinder(radius=radius, segment=segment, sections=20)


def _upright(y: float, radius: float, bottom: float, top: float) -> trimesh.Trimesh:
    """A disc on the tube."""
    segment = np.array([(0.0, y, bottom), (0.0, y, top)])
    return creation.cylinder(radius=radius, segment=segment, sections=12)
