"""A flat paint brush."""

from __future__ import annotations

from functools import cache

import numpy as np
import trimesh
from inhand_tracker.shape.shape import Symmetry
from trimesh import creation

from inhand_lab.objects.model import ObjectModel, build_model

BRISTLES_BELOW = 0.085
"""Distance of the bristles' tips below the origin, which is the middle of the ferrule."""
HANDLE_ABOVE = 0.165
"""Height of the handle's end above the origin."""
HALF_WIDTH = 0.0375
FERRULE_HALF_THICKNESS = 0.011


@cache
def paint_brush() -> ObjectModel:
    """A brush along z with its bristles down, wide along x, flat along y."""
    bristles = _slab([(-BRISTLES_BELOW, 0.034, 0.004), (-0.02, 0.036, 0.010)])
    ferrule = _slab([(z, HALF_WIDTH, FERRULE_HALF_THICKNESS) for z in (-0.022, 0.022)])
    shoulder = _slab([(0.020, 0.035, 0.010), (0.045, 0.027, 0.010), (0.075, 0.012, 0.009)])
    swell = [(0.060, 0.010), (0.085, 0.009), (0.110, 0.010), (0.135, 0.012), (0.155, 0.011)]
    outline = [(0.0, 0.060), *((radius, z) for z, radius in swell), (0.0, HANDLE_ABOVE)]
    handle = creation.revolve(np.array(outline), sections=12)
    marks = [
        (0.034, 0.004, -BRISTLES_BELOW),
        (-0.034, 0.004, -BRISTLES_BELOW),
        (HALF_WIDTH, -0.011, 0.022),
        (-HALF_WIDTH, -0.011, 0.022),
        (HALF_WIDTH, 0.011, -0.022),
        (-HALF_WIDTH, 0.011, -0.022),
        (0.0, 0.0, HANDLE_ABOVE),
    ]
    parts = [
        (shoulder, (186, 130, 70)),
        (handle, (186, 130, 70)),
        (ferrule, (190, 194, 200)),
        (bristles, (70, 52, 40)),
    ]
    return build_model("paint_brush", parts, marks, (Symmetry((0.0, 0.0, 1.0), order=2),))


def _slab(sections: list[tuple[float, float, float]]) -> trimesh.Trimesh:
    """The hull of rectangles at heights z, of these half widths and half thicknesses."""
    corners = [
        (x * wide, y * thick, z)
        for z, wide, thick in sections
        for x in (-1.0, 1.0)
        for y in (-1.0, 1.0)
    ]
    return trimesh.convex.convex_hull(np.array(corners))
