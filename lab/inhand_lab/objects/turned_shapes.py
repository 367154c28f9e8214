"""Round things that stand along z, by their measures: cup, bottle, can, cylinder and stick."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from inhand_lab.objects.model import ObjectModel, build_model, turned

Outline = list[tuple[float, float]]
"""Radii and heights above the bottom, metres, from below round the outside."""

SECTIONS = 48
"""Number of flat sides of a round thing: within 0.2 % of its radius of the round one."""
WALL = 0.003
"""Thickness in metres of a cup's wall and bottom, or less where it is small."""
LARGEST_WALL_SHARE = 0.15
"""Thickness of a cup's wall as a share of its smallest radius, at the most."""
RIM, RIM_SHARE = 0.003, 0.04
"""Height in metres of a can's rims and how far its ends lie within, and that as a share of its
radius, at the most."""
EDGE, EDGE_SHARE = 0.004, 0.1
"""Radius in metres of a bottle's edge at the bottom, and that as a share of its radius."""
NECK_SHARE = 0.4
"""Height of the part of a bottle that is as narrow as its mouth, as a share of what is above the
shoulder."""
PORCELAIN, GLASS, TIN = (196, 198, 202), (70, 108, 92), (168, 172, 178)
PLASTIC, WOOD = (90, 120, 170), (186, 146, 92)


def build_cup(name: str, height: float, diameter: float, foot: float) -> ObjectModel:
    """A cup without a handle, of a diameter at its rim and one at its foot, metres."""
    return _stand(name, cup_outline(height, diameter, foot), PORCELAIN)


def cup_outline(height: float, diameter: float, foot: float) -> Outline:
    """The outline of a cup, its outside and its inside."""
    top, below = diameter / 2.0, foot / 2.0
    wall = min(WALL, LARGEST_WALL_SHARE * min(top, below), LARGEST_WALL_SHARE * height)
    return [
        (0.0, 0.0),
        (below, 0.0),
        (top, height),
        (top - wall, height),
        (below - wall, wall),
        (0.0, wall),
    ]


def build_bottle(
    name: str, height: float, diameter: float, neck: float, shoulder: float
) -> ObjectModel:
    """A closed bottle that is cylindrical up to its shoulder, and narrows to its neck, metres."""
    return _stand(name, bottle_outline(height, diameter, neck, shoulder), GLASS)


def bottle_outline(height: float, diameter: float, neck: float, shoulder: float) -> Outline:
    """The outline of a bottle: its side, a rounded shoulder, and a neck."""
    radius, narrow = diameter / 2.0, neck / 2.0
    edge = min(EDGE, EDGE_SHARE * radius, shoulder / 2.0)
    rise = (1.0 - NECK_SHARE) * (height - shoulder)
    curve = [
        (narrow + (radius - narrow) * (0.5 + 0.5 * np.cos(np.pi * share)), shoulder + rise * share)
        for share in np.linspace(0.0, 1.0, 7)
    ]
    return [
        (0.0, 0.0),
        (radius - edge, 0.0),
        (radius, edge),
        *curve,
        (narrow, height),
        (0.0, height),
    ]


def build_can(name: str, height: float, diameter: float) -> ObjectModel:
    """A can with a rim at both ends, metres."""
    radius = diameter / 2.0
    rim = min(RIM, RIM_SHARE * radius, RIM_SHARE * height)
    outline = [
        (0.0, rim),
        (radius - rim, rim),
        (radius - rim, 0.0),
        (radius, 0.0),
        (radius, height),
        (radius - rim, height),
        (radius - rim, height - rim),
        (0.0, height - rim),
    ]
    return _stand(name, outline, TIN)


def build_cylinder(name: str, height: float, diameter: float) -> ObjectModel:
    """A cylinder, metres."""
    return _stand(name, cylinder_outline(height, diameter), PLASTIC)


def cylinder_outline(height: float, diameter: float) -> Outline:
    """The outline of a cylinder."""
    radius = diameter / 2.0
    return [(0.0, 0.0), (radius, 0.0), (radius, height), (0.0, height)]


def build_stick(name: str, length: float, diameter: float) -> ObjectModel:
    """A round stick along z, metres."""
    return _stand(name, cylinder_outline(length, diameter), WOOD)


def _stand(name: str, outline: Outline, colour: tuple[int, int, int]) -> ObjectModel:
    """The thing that an outline makes; the origin is the middle of its height."""
    half = outline_height(outline) / 2.0
    mesh = turned([(radius, z - half) for radius, z in _subdivided(outline)], SECTIONS)
    widest = max(radius for radius, _ in outline)
    marks = [
        (side * radius, across * radius, z - half)
        for radius, z in _ends(outline)
        for side, across in ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0))
        if radius > 0.1 * widest
    ]
    return build_model(name, [(mesh, colour)], marks)


def outline_height(outline: Outline) -> float:
    """The height of the highest point of an outline."""
    return max(z for _, z in outline)


def _ends(outline: Outline) -> Sequence[tuple[float, float]]:
    """The outermost points at the bottom and at the top of an outline."""
    top = outline_height(outline)
    return [max(point for point in outline if abs(point[1] - z) < 1e-9) for z in (0.0, top)]


def _subdivided(outline: Outline) -> Outline:
    """An outline whose long sides have points between, so that no triangle is a needle."""
    longest = 4.0 * max(radius for radius, _ in outline)
    points = [outline[0]]
    for (r0, z0), (r1, z1) in pairwise(outline):
        pieces = max(int(np.ceil(np.hypot(r1 - r0, z1 - z0) / longest)), 1)
        shares = np.arange(1, pieces + 1) / pieces
        points += [(r0 + (r1 - r0) * share, z0 + (z1 - z0) * share) for share in shares]
    return points
