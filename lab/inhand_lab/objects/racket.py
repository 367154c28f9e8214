"""A tennis racket."""

from __future__ import annotations

from functools import cache

import numpy as np
import trimesh
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.shape.shape import Symmetry
from trimesh import creation

from inhand_lab.objects.model import ObjectModel, build_model, reflected, tube

RACKET_LENGTH = 0.685
HANDLE_LENGTH = 0.20
GRIP_ABOVE_END = 0.075
"""Height of the origin, where the hand is, above the end of the handle."""
TIP = RACKET_LENGTH - GRIP_ABOVE_END
HEAD_HALF_SIZE = (0.125, 0.165)
HEAD_CENTRE = TIP - HEAD_HALF_SIZE[1]
STRING_GAP, STRING_RADIUS = 0.024, 0.0014
"""Distance and radius of the strings: half as many as a real racket has, twice as thick."""
HANDLE_RADIUS = 0.017


@cache
def racket() -> ObjectModel:
    """A racket along z with its tip up, its strings in the plane y = 0, wide along x."""
    rings = np.linspace(-GRIP_ABOVE_END, HANDLE_LENGTH - GRIP_ABOVE_END, 6)
    outline = [(0.0, rings[0]), *((HANDLE_RADIUS, z) for z in rings), (0.0, rings[-1])]
    handle = creation.revolve(np.array(outline), sections=8)
    turn = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 19)
    wide, high = HEAD_HALF_SIZE
    side = tube(_points(wide * np.cos(turn), HEAD_CENTRE + high * np.sin(turn)), 0.010)
    throat = tube(
        _points(np.array([0.008, 0.030, 0.072]), np.array([rings[-1] - 0.02, 0.20, 0.335])), 0.009
    )
    parts = [(handle, (40, 40, 46)), (side, (206, 52, 40)), (throat, (206, 52, 40))]
    parts += [(reflected(part), colour) for part, colour in parts[1:]]
    parts += [(string, (226, 226, 210)) for string in _strings()]
    marks = [
        (0.0, 0.010, TIP),
        (wide + 0.010, 0.0, HEAD_CENTRE),
        (-wide - 0.010, 0.0, HEAD_CENTRE),
        (0.0, 0.010, HEAD_CENTRE - high),
        (HANDLE_RADIUS, 0.0, -GRIP_ABOVE_END),
        (-HANDLE_RADIUS, 0.0, -GRIP_ABOVE_END),
    ]
    return build_model("racket", parts, marks, (Symmetry((0.0, 0.0, 1.0), order=2),))


def _points(x: Array, z: Array) -> Array:
    return np.stack([x, np.zeros(len(x)), z], axis=1)


def _strings() -> list[trimesh.Trimesh]:
    """Straight strings across and along the head, ending at its frame."""
    wide, high = HEAD_HALF_SIZE
    across = np.arange(-high + 0.02, high - 0.01, STRING_GAP)
    along = np.arange(-wide + 0.017, wide - 0.01, STRING_GAP)
    half_across = wide * np.sqrt(1.0 - (across / high) ** 2)
    half_along = high * np.sqrt(1.0 - (along / wide) ** 2)
    ends = [
        *(
            ((-half, HEAD_CENTRE + z), (half, HEAD_CENTRE + z))
            for z, half in zip(across, half_across, strict=True)
        ),
        *(
            ((x, HEAD_CENTRE - half), (x, HEAD_CENTRE + half))
            for x, half in zip(along, half_along, strict=True)
        ),
    ]
    return [
        creation.cylinder(radius=STRING_RADIUS, segment=[(x0, 0.0, z0), (x1, 0.0, z1)], sections=3)
        for (x0, z0), (x1, z1) in ends
    ]
