"""An open right hand of an adult, to draw beside an object so that its size is seen at a glance."""

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.surfaces import Surface, ellipsoid, join_surfaces, limb
from inhand_lab.geometry.transforms import Transform, rotation_about

HAND_LENGTH = 0.186
"""Length in metres of the hand from the wrist to the tip of the middle finger, between the means of
ANSUR II for women and men (Gordon et al., 2014: 0.181 m and 0.193 m)."""
HAND_BREADTH = 0.083
"""Breadth in metres of the hand across the knuckles, between the same means."""
PALM_LENGTH = 0.105
SKIN = (222, 178, 150)
FINGERS = (
    (-0.029, 0.069, 0.0094, 0.08),
    (-0.009, 0.079, 0.0098, 0.02),
    (0.011, 0.074, 0.0094, -0.04),
    (0.030, 0.057, 0.0082, -0.12),
)
"""Place across the knuckles, length, radius, all in metres, and how far each spreads, radians."""
THUMB_ROOT, THUMB_LENGTH, THUMB_RADIUS, THUMB_TURN = (-0.030, 0.0, 0.040), 0.072, 0.0098, -0.75


def open_hand() -> Surface:
    """The hand upright along z, the middle of its wrist at the origin, its palm towards -y."""
    palm = ellipsoid(
        (0.0, 0.0, 0.52 * PALM_LENGTH),
        (0.52 * HAND_BREADTH, 0.0145, 0.57 * PALM_LENGTH),
        SKIN,
        detail=3,
    )
    wrist = _placed(limb(0.035, 0.026, 0.028, SKIN), (0.0, 0.0, -0.02), 0.0)
    wrist = Surface(wrist.vertices * (1.0, 0.62, 1.0), wrist.normals, wrist.faces, wrist.colours)
    fingers = [
        _placed(limb(length, radius, 0.84 * radius, SKIN), _knuckle(across), -spread)
        for across, length, radius, spread in FINGERS
    ]
    thumb = limb(THUMB_LENGTH, 1.25 * THUMB_RADIUS, 0.84 * THUMB_RADIUS, SKIN)
    return join_surfaces([palm, wrist, *fingers, _placed(thumb, THUMB_ROOT, THUMB_TURN)])


def _knuckle(across: float) -> tuple[float, float, float]:
    """Knuckles lie on an arc, that of the little finger the lowest."""
    return across, 0.0, PALM_LENGTH - 0.006 - 9.0 * (across + 0.008) ** 2


def _placed(surface: Surface, root: tuple[float, float, float], turn: float) -> Surface:
    """A limb from a root, turned about y by an angle in radians."""
    place: Array = np.array(root)
    return surface.moved(Transform(place, rotation_about("y", turn)))
