"""A mug."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
import trimesh

from inhand_lab.objects.model import ObjectModel, build_model, tube, turned

MUG_HEIGHT = 0.096
MUG_RADIUS = 0.041
MUG_WALL = 0.004
MUG_BOTTOM = 0.006
"""Thickness of the mug's bottom."""
MUG_HANDLE_REACH = 0.033
"""Distance from the mug's wall to the middle of its handle's bar."""
RED = (178, 40, 46)


@dataclass(frozen=True)
class MugMeasures:
    """Measures of a mug, metres."""

    height: float = MUG_HEIGHT
    radius: float = MUG_RADIUS
    """Radius of the outside of the wall."""
    wall: float = MUG_WALL
    """Thickness of the wall."""
    handle_reach: float = MUG_HANDLE_REACH
    """Distance from the wall to the middle of the handle's bar."""
    handle_half_height: float = 0.030
    """Half of the distance between the places where the handle meets the wall."""
    bar_radius: float = 0.006
    """Radius of the handle's bar."""


@cache
def mug() -> ObjectModel:
    """A mug standing along z, its handle towards +y; the origin is the middle of the cup."""
    return build_mug("mug", MugMeasures())


def build_mug(name: str, measures: MugMeasures) -> ObjectModel:
    """A mug of any measures, as ``mug`` stands."""
    half, radius, reach = measures.height / 2.0, measures.radius, measures.handle_reach
    parts = [(_cup(measures), RED), (_handle(measures), RED)]
    aside = 0.7 * radius
    marks = [
        (radius, 0.0, half),
        (-radius, 0.0, half),
        (0.0, -radius, half),
        (0.0, radius, half),
        (aside, -aside, -half),
        (-aside, -aside, -half),
        (0.0, radius + reach + measures.bar_radius, 0.0),
    ]
    return build_model(name, parts, marks)


def _cup(measures: MugMeasures) -> trimesh.Trimesh:
    """The mug without its handle: an edge under its foot, and a bottom of 6 mm."""
    half, radius, wall = measures.height / 2.0, measures.radius, measures.wall
    outline = [
        (0.0, -half),
        (radius - 0.003, -half),
        (radius, -half + 0.004),
        (radius, half),
        (radius - wall, half),
        (radius - wall, -half + MUG_BOTTOM),
        (0.0, -half + MUG_BOTTOM),
    ]
    return turned(outline, sections=40)


def _handle(measures: MugMeasures) -> trimesh.Trimesh:
    """The handle's bar, whose ends are inside the wall."""
    inside = measures.radius - 0.002
    angles = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 13)
    loop = np.stack(
        [
            np.zeros(13),
            inside + (measures.handle_reach + 0.002) * np.cos(angles) ** 0.7,
            measures.handle_half_height * np.sin(angles),
        ],
        axis=1,
    )
    return tube(loop, measures.bar_radius)
