"""A mug."""

from __future__ import annotations

from functools import cache

import numpy as np
from trimesh import creation

from inhand_lab.objects.model import ObjectModel, build_model, tube

MUG_HEIGHT = 0.096
MUG_RADIUS = 0.041
MUG_WALL = 0.004
MUG_HANDLE_REACH = 0.033
"""Distance from the mug's wall to the middle of its handle's bar."""


@cache
def mug() -> ObjectModel:
    """A mug standing along z, its handle towards +y; the origin is the middle of the cup."""
    half = MUG_HEIGHT / 2.0
    outline = [
        (0.0, -half),
        (MUG_RADIUS - 0.003, -half),
        (MUG_RADIUS, -half + 0.004),
        (MUG_RADIUS, half),
        (MUG_RADIUS - MUG_WALL, half),
        (MUG_RADIUS - MUG_WALL, -half + 0.006),
        (0.0, -half + 0.006),
    ]
    cup = creation.revolve(np.array(outline), sections=40)
    reach = MUG_RADIUS - 0.002
    angles = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 13)
    loop = np.stack(
        [
            np.zeros(13),
            reach + (MUG_HANDLE_REACH + 0.002) * np.cos(angles) ** 0.7,
            0.030 * np.sin(angles),
        ],
        axis=1,
    )
    handle = tube(loop, 0.006)
    marks = [
        (MUG_RADIUS, 0.0, half),
        (-MUG_RADIUS, 0.0, half),
        (0.0, -MUG_RADIUS, half),
        (0.0, MUG_RADIUS, half),
        (0.028, -0.028, -half),
        (-0.028, -0.028, -half),
        (0.0, MUG_RADIUS + MUG_HANDLE_REACH + 0.006, 0.0),
    ]
    return build_model("mug", [(cup, (178, 40, 46)), (handle, (178, 40, 46))], marks)
