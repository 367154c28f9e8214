"""A bottle of vinegar with a sprinkler top."""

from __future__ import annotations

from functools import cache

import trimesh
from inhand_tracker.shape.shape import Symmetry

from inhand_lab.objects.model import ObjectModel, build_model, turned

BOTTLE_HEIGHT = 0.215
BOTTLE_RADIUS = 0.031
BOTTLE_HALF_HEIGHT = BOTTLE_HEIGHT / 2.0
VINEGAR, LABEL, CAP = (94, 48, 22), (226, 206, 150), (190, 32, 36)

GLASS = (
    *((0.027, 0.0), (BOTTLE_RADIUS, 0.005), (BOTTLE_RADIUS, 0.105)),
    *((0.029, 0.120), (0.022, 0.142), (0.015, 0.162), (0.0125, 0.175), (0.0125, 0.188)),
)
"""Radius and height above the bottom, from below upwards."""
BAND = ((BOTTLE_RADIUS + 0.0006, 0.030), (BOTTLE_RADIUS + 0.0006, 0.088))
TOP = ((0.0140, 0.186), (0.0140, 0.202), (0.0060, 0.207), (0.0050, BOTTLE_HEIGHT))


@cache
def vinegar_bottle() -> ObjectModel:
    """A round bottle standing along z, its label all around; the origin is its middle."""
    parts = [(_turned(GLASS), VINEGAR), (_turned(BAND), LABEL), (_turned(TOP), CAP)]
    marks = [
        (0.0, 0.0, BOTTLE_HALF_HEIGHT),
        (0.0, 0.0, -BOTTLE_HALF_HEIGHT),
        *((side * 0.014, 0.0, 0.202 - BOTTLE_HALF_HEIGHT) for side in (-1.0, 1.0)),
        *((side * BOTTLE_RADIUS, 0.0, 0.105 - BOTTLE_HALF_HEIGHT) for side in (-1.0, 1.0)),
        *((side * BOTTLE_RADIUS, 0.0, 0.005 - BOTTLE_HALF_HEIGHT) for side in (-1.0, 1.0)),
    ]
    return build_model("vinegar_bottle", parts, marks, (Symmetry((0.0, 0.0, 1.0)),))


def _turned(outline: tuple[tuple[float, float], ...]) -> trimesh.Trimesh:
    """A closed solid of revolution of an outline of radii and heights above the bottom."""
    solid = turned([(0.0, outline[0][1]), *outline, (0.0, outline[-1][1])], sections=32)
    solid.apply_translation([0.0, 0.0, -BOTTLE_HALF_HEIGHT])
    return solid
