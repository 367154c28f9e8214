"""A weights bar as people have at home."""

from __future__ import annotations

from functools import cache

import trimesh
from inhand_tracker.shape.shape import Symmetry
from trimesh import creation

from inhand_lab.objects.model import ObjectModel, build_model, reflected

BAR_HALF_LENGTH = 0.60
BAR_RADIUS = 0.0125
PLATE_RADIUS = 0.105
PLATES = ((0.435, 0.463, PLATE_RADIUS), (0.465, 0.485, 0.080))
"""Inner face, outer face and radius of each plate on one side."""
STEEL, KNURLED, IRON = (172, 174, 178), (112, 114, 118), (44, 46, 52)


@cache
def barbell() -> ObjectModel:
    """A bar along x with two plates at each end; the origin is the middle of it."""
    smooth = _rod(-0.10, 0.10, BAR_RADIUS)
    right = [
        (_rod(0.10, 0.36, BAR_RADIUS), KNURLED),
        (_rod(0.36, BAR_HALF_LENGTH, BAR_RADIUS), STEEL),
        (_rod(0.405, 0.435, 0.024), STEEL),
        *((_rod(inner, outer, radius), IRON) for inner, outer, radius in PLATES),
        (_rod(0.487, 0.515, 0.024), STEEL),
    ]
    left = [(reflected(part), colour) for part, colour in right]
    marks = [
        (side * x, y, 0.0)
        for side in (-1.0, 1.0)
        for x, y in (
            (BAR_HALF_LENGTH, 0.0),
            (PLATES[0][0], PLATE_RADIUS),
            (PLATES[0][0], -PLATE_RADIUS),
        )
    ]
    symmetries = (Symmetry((1.0, 0.0, 0.0)), Symmetry((0.0, 0.0, 1.0), order=2))
    return build_model("barbell", [(smooth, STEEL), *right, *left], marks, symmetries)


def _rod(start: float, end: float, radius: float) -> trimesh.Trimesh:
    """A cylinder along x."""
    return creation.cylinder(radius=radius, segment=[(start, 0, 0), (end, 0, 0)], sections=32)
