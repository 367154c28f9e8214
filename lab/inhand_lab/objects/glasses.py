"""Spectacles."""

from __future__ import annotations

from functools import cache

import numpy as np
import trimesh
from trimesh import creation

from inhand_lab.objects.model import Z_TO_MINUS_Y, ObjectModel, build_model, reflected, tube

LENS_CENTRE = 0.033
LENS_HALF_SIZE = (0.026, 0.021)
TEMPLE_OFFSET = 0.078
TEMPLE_LENGTH = 0.14
EAR_DROP = 0.025
FRAME_COLOUR = (30, 28, 32)
LENS_COLOUR = (70, 82, 96)


@cache
def glasses() -> ObjectModel:
    """Spectacles as worn: x to the wearer's right, y forward, z up; the origin is the bridge."""
    rim = trimesh.creation.torus(1.0, 0.10, major_sections=28, minor_sections=6)
    rim.apply_scale([LENS_HALF_SIZE[0], LENS_HALF_SIZE[1], 0.026])
    lens = creation.cylinder(radius=1.0, height=0.0016, sections=28)
    lens.apply_scale([LENS_HALF_SIZE[0], LENS_HALF_SIZE[1], 1.0])
    for part in (rim, lens):
        part.apply_transform(Z_TO_MINUS_Y)
        part.apply_translation([LENS_CENTRE, 0.0, 0.0])
    hinge = LENS_CENTRE + 0.95 * LENS_HALF_SIZE[0]
    temple = tube(
        np.array(
            [
                (hinge, 0.0, 0.006),
                (TEMPLE_OFFSET, -0.012, 0.008),
                (TEMPLE_OFFSET, 0.045 - TEMPLE_LENGTH, 0.004),
                (TEMPLE_OFFSET - 0.002, -TEMPLE_LENGTH, -EAR_DROP),
            ]
        ),
        0.0032,
    )
    right = [(rim, FRAME_COLOUR), (lens, LENS_COLOUR), (temple, FRAME_COLOUR)]
    left = [(reflected(part), colour) for part, colour in right]
    arch = np.array([(-0.010, 0.001, 0.006), (0.0, 0.003, 0.009), (0.010, 0.001, 0.006)])
    parts = [*right, *left, (tube(arch, 0.003), FRAME_COLOUR)]
    edge = LENS_CENTRE + LENS_HALF_SIZE[0]
    marks = [
        (0.0, 0.003, 0.012),
        (edge, 0.0, 0.0),
        (-edge, 0.0, 0.0),
        (LENS_CENTRE, 0.0, -LENS_HALF_SIZE[1]),
        (-LENS_CENTRE, 0.0, -LENS_HALF_SIZE[1]),
        (TEMPLE_OFFSET, -TEMPLE_LENGTH, -EAR_DROP),
        (-TEMPLE_OFFSET, -TEMPLE_LENGTH, -EAR_DROP),
    ]
    return build_model("glasses", parts, marks)
