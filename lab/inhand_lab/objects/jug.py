"""A small cream jug."""

from __future__ import annotations

from functools import cache

import numpy as np
import trimesh
from inhand_tracker.geometry.arrays import Array
from trimesh import creation

from inhand_lab.objects.model import ObjectModel, build_model, tube

JUG_HEIGHT = 0.088
JUG_BELLY = 0.037
JUG_RIM = 0.031
JUG_WALL = 0.003
JUG_HANDLE_REACH = 0.030
"""Distance from the jug's belly to the middle of its handle's bar."""
SPOUT_REACH = 0.017
"""Length of the spout beyond the rim."""
SPOUT = np.array([0.0, JUG_RIM + SPOUT_REACH, JUG_HEIGHT / 2.0 + 0.004])
"""Tip of the spout in the jug's frame."""
CREAM = (238, 232, 214)

_HALF = JUG_HEIGHT / 2.0
JUG_OUTSIDE = (
    (0.0, -_HALF),
    (0.025, -_HALF),
    (0.028, -_HALF + 0.004),
    (0.035, -0.026),
    (JUG_BELLY, -0.012),
    (0.034, 0.006),
    (0.027, 0.026),
    (0.028, 0.036),
    (JUG_RIM, _HALF),
)
"""Radii and heights of the jug's outside without its spout, from below, metres."""
JUG_INSIDE = (
    *((radius - JUG_WALL, z) for radius, z in JUG_OUTSIDE[:2:-1]),
    (0.024, -_HALF + 0.006),
)
"""The same of its inside, from the rim to the bottom's edge."""


@cache
def jug() -> ObjectModel:
    """A jug standing along z, its spout towards +y; the origin is the middle of its height."""
    half = _HALF
    outline = np.array([*JUG_OUTSIDE, *JUG_INSIDE, (0.0, -half + 0.006)])
    vessel = creation.revolve(outline, sections=40)
    vessel = trimesh.Trimesh(with_spout(np.asarray(vessel.vertices)), vessel.faces, process=False)
    angles = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 13)
    loop = np.stack(
        [
            np.zeros(13),
            -0.028 - (JUG_BELLY + JUG_HANDLE_REACH - 0.028) * np.cos(angles) ** 0.7,
            0.004 + 0.028 * np.sin(angles),
        ],
        axis=1,
    )
    marks = [
        (SPOUT[0], SPOUT[1], SPOUT[2]),
        (JUG_RIM, 0.0, half),
        (-JUG_RIM, 0.0, half),
        (0.0, -JUG_RIM, half),
        (0.0, 0.025, -half),
        (0.022, -0.012, -half),
        (-0.022, -0.012, -half),
        (0.0, -JUG_BELLY - JUG_HANDLE_REACH - 0.005, 0.004),
    ]
    return build_model("jug", [(vessel, CREAM), (tube(loop, 0.005), CREAM)], marks)


def with_spout(vertices: Array) -> Array:
    """A vessel's vertices (V, 3) with the rim drawn out and up about +y."""
    x, y, z = vertices.T
    high = np.clip((z - 0.020) / (JUG_HEIGHT / 2.0 - 0.020), 0.0, 1.0) ** 2
    ahead = np.clip(y / np.maximum(np.hypot(x, y), 1e-9), 0.0, 1.0) ** 8
    drawn = high * ahead
    return np.stack([x * (1.0 - 0.35 * drawn), y + SPOUT_REACH * drawn, z + 0.004 * drawn], axis=1)
