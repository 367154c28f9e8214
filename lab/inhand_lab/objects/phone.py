"""A mobile phone."""

from __future__ import annotations

from functools import cache

import numpy as np
import trimesh
from trimesh import creation

from inhand_lab.objects.model import ObjectModel, build_model

PHONE_WIDTH = 0.071
PHONE_LENGTH = 0.147
PHONE_THICKNESS = 0.009
CORNER_RADIUS = 0.010
BODY_COLOUR, SCREEN_COLOUR, CAMERA_COLOUR = (196, 198, 204), (26, 30, 40), (40, 40, 44)


@cache
def phone() -> ObjectModel:
    """A phone along z, its screen towards +y and its earpiece up; the origin is its middle."""
    half_width, half_length = PHONE_WIDTH / 2.0, PHONE_LENGTH / 2.0
    back, front = -PHONE_THICKNESS / 2.0, PHONE_THICKNESS / 2.0
    body = _plate(half_width, half_length, CORNER_RADIUS, back, front - 0.0004)
    screen = _plate(half_width - 0.003, half_length - 0.006, 0.007, front - 0.0010, front)
    lenses = creation.box(extents=(0.024, 0.0016, 0.024))
    lenses.apply_translation([0.0, back - 0.0006, half_length - 0.022])
    edge = 0.3 * CORNER_RADIUS
    marks = [
        (side * (half_width - edge), face, end * (half_length - edge))
        for side in (-1.0, 1.0)
        for end in (-1.0, 1.0)
        for face in (back, front)
    ]
    parts = [(body, BODY_COLOUR), (screen, SCREEN_COLOUR), (lenses, CAMERA_COLOUR)]
    return build_model("phone", parts, marks)


def _plate(
    half_width: float, half_length: float, corner: float, back: float, front: float
) -> trimesh.Trimesh:
    """A plate in the plane y = 0 with rounded corners, from y = back to y = front."""
    angles = np.linspace(0.0, 0.5 * np.pi, 5)
    quarter = np.stack([np.cos(angles), np.sin(angles)], axis=1) * corner
    quarter += np.array([half_width, half_length]) - corner
    outline = [quarter * (x, z) for x in (-1.0, 1.0) for z in (-1.0, 1.0)]
    points = [(x, y, z) for y in (back, front) for part in outline for x, z in part]
    return trimesh.convex.convex_hull(np.array(points))
