"""A box, and tools with a handle along z, by their measures: mallet and paddle."""

from __future__ import annotations

import itertools

import numpy as np
import trimesh
from trimesh import creation

from inhand_lab.objects.model import ObjectModel, build_model

CARDBOARD, WOOD, RUBBER = (184, 148, 104), (186, 146, 92), (44, 46, 52)
THICKEST_BLADE, BLADE_SHARE = 0.012, 0.12
"""Thickness in metres of a paddle's blade at the most, and as a share of its width."""
SIDES = 24
"""Number of flat sides of a round handle or head."""


def build_box(name: str, height: float, width: float, depth: float) -> ObjectModel:
    """A box standing along z, wide along x and deep along y, metres; the origin is its middle."""
    extents = np.array([width, depth, height])
    corners = np.array(list(itertools.product((-0.5, 0.5), repeat=3))) * extents
    marks = [(x, y, z) for x, y, z in corners.tolist()]
    return build_model(name, [(creation.box(extents=extents), CARDBOARD)], marks)


def build_mallet(name: str, length: float, head: float, face: float, handle: float) -> ObjectModel:
    """A mallet: a round head along y, of a length and of the diameter of its two faces, on a round
    handle of a diameter along z, metres; the origin is the middle of its length."""
    half, radius = length / 2.0, face / 2.0
    high = half - radius
    block = creation.cylinder(
        radius=radius,
        segment=np.array([(0.0, -head / 2.0, high), (0.0, head / 2.0, high)]),
        sections=SIDES,
    )
    marks = [(0.0, y * head / 2.0, high + z * radius) for y in (1.0, -1.0) for z in (1.0, -1.0)]
    marks += [(x * handle / 2.0, 0.0, -half) for x in (1.0, -1.0)]
    return build_model(name, [(block, RUBBER), (_rod(handle, -half, high), WOOD)], marks)


def build_paddle(
    name: str, length: float, blade_length: float, blade_width: float, handle: float
) -> ObjectModel:
    """A flat blade on a round handle along z: a spatula, a bat, a wide brush.

    The blade is wide along x and is at the upper end; the origin is the middle of the length.
    """
    half, foot = length / 2.0, length / 2.0 - blade_length
    thick = min(THICKEST_BLADE, BLADE_SHARE * blade_width)
    blade = creation.box(extents=(blade_width, thick, blade_length))
    blade.apply_translation([0.0, 0.0, foot + blade_length / 2.0])
    marks = [(x * blade_width / 2.0, thick / 2.0, z) for x in (1.0, -1.0) for z in (foot, half)] + [
        (x * handle / 2.0, 0.0, -half) for x in (1.0, -1.0)
    ]
    rod = _rod(handle, -half, foot + min(blade_length, handle) / 2.0)
    return build_model(name, [(blade, RUBBER), (rod, WOOD)], marks)


def _rod(diameter: float, bottom: float, top: float) -> trimesh.Trimesh:
    """A round rod along z."""
    ends = np.array([(0.0, 0.0, bottom), (0.0, 0.0, top)])
    return creation.cylinder(radius=diameter / 2.0, segment=ends, sections=SIDES)
