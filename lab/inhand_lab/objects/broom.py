"""A broom."""

from __future__ import annotations

from functools import cache

import numpy as np
import trimesh
from trimesh import creation

from inhand_lab.objects.model import ObjectModel, build_model

BROOM_LENGTH = 1.38
"""Length from the tips of the bristles to the end of the handle."""
BROOM_HALF_LENGTH = BROOM_LENGTH / 2.0
HANDLE_RADIUS = 0.0125


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
    return build_model("broom", parts, marks)
