"""A claw hammer."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
import trimesh
from trimesh import creation

from inhand_lab.objects.model import ObjectModel, build_model

HAMMER_LENGTH = 0.33
HAMMER_HALF_LENGTH = HAMMER_LENGTH / 2.0
HEAD_BELOW_TOP = 0.016
HEAD_HEIGHT = HAMMER_HALF_LENGTH - HEAD_BELOW_TOP
"""Height of the striking face's axis along the handle."""
FACE_REACH = 0.062
"""Distance from the handle's axis to the striking face."""
FACE_RADIUS = 0.0135
HEAD_LENGTH = FACE_REACH + 0.074
"""Distance from the striking face to the tips of the claw."""
HANDLE_HALF_SIZE = (0.011, 0.016)
STEEL, RUBBER, ASH = (122, 126, 134), (34, 36, 40), (202, 164, 104)

Part = tuple[trimesh.Trimesh, tuple[int, int, int]]
Section = tuple[float, float, float, float]
"""A rectangle square to y: its y, its z, half its width and half its height, metres."""


@dataclass(frozen=True)
class HammerMeasures:
    """Measures of a claw hammer, metres."""

    length: float = HAMMER_LENGTH
    head_length: float = HEAD_LENGTH
    """Distance from the striking face to the tips of the claw."""
    face_diameter: float = 2.0 * FACE_RADIUS
    handle_width: float = 2.0 * HANDLE_HALF_SIZE[1]
    """Width of the handle where it is held, seen from the side."""


@cache
def hammer() -> ObjectModel:
    """A hammer with its handle along z, striking towards +y; the origin is its middle."""
    return build_hammer("hammer", HammerMeasures())


def build_hammer(name: str, measures: HammerMeasures) -> ObjectModel:
    """A hammer of any measures, as ``hammer`` lies."""
    top = measures.length / 2.0
    along = measures.head_length / HEAD_LENGTH
    thick = measures.face_diameter / (2.0 * FACE_RADIUS)
    high = top - HEAD_BELOW_TOP * thick
    held = np.array(HANDLE_HALF_SIZE) * (measures.handle_width / (2.0 * HANDLE_HALF_SIZE[1]))
    reach, radius = FACE_REACH * along, FACE_RADIUS * thick
    claw_y, claw_z, wide = -0.074 * along, high - 0.030 * thick, 0.014 * thick
    marks = [
        (0.0, reach, high + radius),
        (0.0, reach, high - radius),
        (wide, claw_y, claw_z),
        (-wide, claw_y, claw_z),
        (0.0, 0.0, top),
        (held[0], 0.0, -top),
        (-held[0], 0.0, -top),
    ]
    parts = [*_head(high, along, thick), *_handle(measures)]
    return build_model(name, parts, marks)


def _head(high: float, along: float, thick: float) -> list[Part]:
    """Face, neck, eye and claw at a height, by factors on their length and their thickness."""

    def rod(radius: float, start: float, end: float, sections: int) -> trimesh.Trimesh:
        ends = np.array([(0, start * along, high), (0, end * along, high)])
        return creation.cylinder(radius=radius * thick, segment=ends, sections=sections)

    def bar(first: Section, second: Section) -> trimesh.Trimesh:
        # Here z is counted from the face's axis downwards.
        return _bar(
            *(
                (y * along, high - below * thick, wide * thick, up * thick)
                for y, below, wide, up in (first, second)
            )
        )

    return [
        (rod(FACE_RADIUS, 0.044, FACE_REACH, 20), STEEL),
        (rod(0.0105, 0.016, 0.046, 16), STEEL),
        (bar((0.0, 0.0, 0.014, 0.016), (0.018, 0.0, 0.012, 0.012)), STEEL),
        (bar((0.002, 0.0, 0.013, 0.016), (-0.040, 0.010, 0.017, 0.007)), STEEL),
        (bar((-0.038, 0.009, 0.017, 0.007), (-0.074, 0.030, 0.014, 0.002)), STEEL),
    ]


def _handle(measures: HammerMeasures) -> list[Part]:
    """The shaft, and the rubber at its end."""
    top, long = measures.length / 2.0, measures.length / HAMMER_LENGTH
    thick = measures.handle_width / (2.0 * HANDLE_HALF_SIZE[1])
    shaft, rubber = (0.010 * thick, 0.014 * thick), (0.011 * thick, 0.016 * thick)
    return [
        (_post(-top + 0.115 * long, top, shaft), ASH),
        (_post(-top, -top + 0.120 * long, rubber), RUBBER),
    ]


def _post(bottom: float, top: float, half_size: tuple[float, float]) -> trimesh.Trimesh:
    """An oval rod along z."""
    rod = creation.cylinder(radius=1.0, height=top - bottom, sections=16)
    rod.apply_scale([*half_size, 1.0])
    rod.apply_translation([0.0, 0.0, 0.5 * (bottom + top)])
    return rod


def _bar(first: Section, second: Section) -> trimesh.Trimesh:
    """A wedge between two rectangles square to y, each (y, z, half width, half height)."""
    corners = [
        (x * wide, y, z + up * high)
        for y, z, wide, high in (first, second)
        for x in (-1.0, 1.0)
        for up in (-1.0, 1.0)
    ]
    return trimesh.convex.convex_hull(np.array(corners))
