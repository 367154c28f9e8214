"""A magnifying glass."""

from __future__ import annotations

from functools import cache

from inhand_tracker.shape.shape import Symmetry
from trimesh import creation

from inhand_lab.objects.model import Z_TO_MINUS_Y, ObjectModel, build_model

LENS_RADIUS = 0.045
RIM_RADIUS = 0.005
HANDLE_RADIUS = 0.009
HANDLE_TOP, HANDLE_END = -0.062, -0.168
"""Places along z at which the handle begins and ends."""
RIM_COLOUR, LENS_COLOUR, HANDLE_COLOUR = (168, 140, 70), (196, 212, 220), (70, 40, 26)


@cache
def magnifier() -> ObjectModel:
    """A magnifying glass in the plane y = 0, its handle towards -z; the origin is the lens.

    Half a turn about the handle leaves it as it is.
    """
    rim = creation.torus(LENS_RADIUS, RIM_RADIUS, major_sections=40, minor_sections=8)
    lens = creation.cylinder(radius=LENS_RADIUS, height=0.005, sections=40)
    for part in (rim, lens):
        part.apply_transform(Z_TO_MINUS_Y)
    neck = creation.cylinder(
        radius=0.005, segment=[(0.0, 0.0, -LENS_RADIUS), (0.0, 0.0, HANDLE_TOP)], sections=12
    )
    handle = creation.cylinder(
        radius=HANDLE_RADIUS,
        segment=[(0.0, 0.0, HANDLE_TOP), (0.0, 0.0, HANDLE_END)],
        sections=16,
    )
    outside = LENS_RADIUS + RIM_RADIUS
    marks = [
        (0.0, 0.0, outside),
        (outside, 0.0, 0.0),
        (-outside, 0.0, 0.0),
        (0.0, HANDLE_RADIUS, HANDLE_TOP),
        (0.0, -HANDLE_RADIUS, HANDLE_TOP),
        (HANDLE_RADIUS, 0.0, HANDLE_END),
        (-HANDLE_RADIUS, 0.0, HANDLE_END),
    ]
    parts = [
        (rim, RIM_COLOUR),
        (lens, LENS_COLOUR),
        (neck, RIM_COLOUR),
        (handle, HANDLE_COLOUR),
    ]
    return build_model("magnifier", parts, marks, (Symmetry((0.0, 0.0, 1.0), order=2),))
