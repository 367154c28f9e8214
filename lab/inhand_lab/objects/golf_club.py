"""A golf club: an iron for a right-handed player."""

from __future__ import annotations

from functools import cache

import numpy as np
import trimesh
from trimesh import creation

from inhand_lab.objects.model import ObjectModel, build_model

CLUB_LENGTH = 0.95
"""Length from the sole of the head to the end of the grip: a seven iron's."""
GRIP_LENGTH = 0.27
HANDS_BELOW_END = 0.115
"""Distance of the origin, which is between the two hands, below the end of the grip."""
SOLE = HANDS_BELOW_END - CLUB_LENGTH
LOFT = np.radians(30.0)
GRIP_RADIUS, SHAFT_RADIUS = 0.0125, 0.0055


@cache
def golf_club() -> ObjectModel:
    """An iron: z up the shaft to the grip, y to the toe of the head, x away from the target.

    Clubs for the left hand are the mirror images of clubs for the right, so that no club is its
    own. The plane x = 0 holds the shaft and the length of the head, square to where the ball goes:
    a club for the left hand is this one reflected in it. Only the blade, a few millimetres thick,
    differs between the two, by its loft.
    """
    end = HANDS_BELOW_END
    rings = np.linspace(end - GRIP_LENGTH, end, 9)
    outline = [(0.0, rings[0]), *((GRIP_RADIUS, z) for z in rings), (0.0, end)]
    grip = creation.revolve(np.array(outline), sections=12)
    shaft = creation.cylinder(
        radius=SHAFT_RADIUS,
        segment=[(0.0, 0.0, SOLE + 0.04), (0.0, 0.0, end - GRIP_LENGTH + 0.01)],
        sections=12,
    )
    hosel = creation.cylinder(
        radius=0.0068, segment=[(0.0, 0.0, SOLE + 0.012), (0.0, 0.0, SOLE + 0.075)], sections=12
    )
    parts = [(grip, (36, 36, 40)), (shaft, (176, 180, 186)), (hosel, (120, 124, 130))]
    marks = [
        (0.0, GRIP_RADIUS, end),
        (0.0, -GRIP_RADIUS, end),
        (0.0, GRIP_RADIUS, end - GRIP_LENGTH),
        (0.0, SHAFT_RADIUS, SOLE + 0.04),
        (0.0, 0.076, SOLE + 0.006),
        (0.0, 0.076, SOLE + 0.056),
        (0.0, -0.006, SOLE + 0.002),
    ]
    return build_model("golf_club", [*parts, (_blade(), (150, 154, 160))], marks)


def _blade() -> trimesh.Trimesh:
    """The head: low at the heel, high at the toe, leaning back from the target by the loft."""
    profile = np.array(
        [(-0.008, 0.0), (-0.008, 0.022), (0.070, 0.058), (0.080, 0.045), (0.078, 0.0)]
    )
    lean = np.tan(LOFT) * (profile[:, 1] - 0.028)
    corners = [
        (lean[number] + face, along, SOLE + up)
        for number, (along, up) in enumerate(profile)
        for face in (-0.004, 0.004 + 0.006 * (up < 0.01))
    ]
    return trimesh.convex.convex_hull(np.array(corners))
