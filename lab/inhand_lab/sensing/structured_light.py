"""Depth as a Kinect's projector and infrared camera measure it.

Depth is a disparity in steps of one eighth of a pixel with a baseline of 7.5 cm and a focal length
of 580 pixels (Khoshelham & Elberink, Sensors 2012), so that the step grows with the square of the
distance: 18 mm at 2.5 m. Its noise has an axial deviation of 1.2 mm + 1.9 mm/m^2 (z - 0.4 m)^2 and
a lateral one of 0.8 pixels (Nguyen, Izadi & Lovell, 3DIMPVT 2012), correlated between neighbours
as block matching makes it. Most of it stands still, for the projected dots do: in UTD-MHAD only a
sixth of a resting chest's pixels differ from one frame to the next. Nothing is measured where the
projector, to the right of the camera, casts the shadow of a nearer surface, on some of the pixels
at an edge, on what returns no light, and outside 0.5 to 8 m.
"""

from __future__ import annotations

import numba
import numpy as np
from inhand_tracker.geometry.camera import Intrinsics
from numpy.typing import NDArray

from inhand_lab.geometry.rasteriser import Canvas
from inhand_lab.sensing.noise_fields import FIELD, NoiseFields, Place, noise_fields

BASELINE = 0.075
STEPS_PER_PIXEL = 8.0
NEAREST, FURTHEST = 0.5, 8.0
LATERAL_DEVIATION = 0.8
FRESH = 0.25
"""Share of the deviation that is new in every frame."""
SHADOW = 3.0
"""Width in pixels of a shadow that the matching window still bridges."""
EDGE_JUMP = 0.05
"""A relative change of depth between neighbours that counts as an edge."""
EDGE_LOSS = 0.11
"""Share of the pixels at an edge that return nothing."""


def measure(
    canvas: Canvas, intrinsics: Intrinsics, unseen: int, lasting: Place, fresh: Place
) -> NDArray[np.uint16]:
    """Depth (H, W) in millimetres, 0 where nothing was measured.

    unseen is the label of what returns no light, 0 if all does. Noise is looked up from two
    places: one lasts as long as the camera stands still, the other is of this frame.
    """
    fields = _fields()
    depth = _measure(
        canvas.inverse_depth,
        canvas.labels,
        unseen,
        intrinsics.fx,
        fields.axial,
        fields.lateral,
        fields.patches,
        *lasting,
        *fresh,
    )
    return np.asarray(depth)


def _fields() -> NoiseFields:
    return noise_fields(1.2, LATERAL_DEVIATION, 1.5)


@numba.njit(cache=True, nogil=True)
def _measure(  # type: ignore[no-untyped-def]
    inverse_depth,
    labels,
    unseen,
    focal,
    axial,
    lateral,
    patches,
    row,
    column,
    fresh_row,
    fresh_column,
):
    height, width = inverse_depth.shape
    depth = np.zeros((height, width), np.uint16)
    steps = np.float32(580.0 * BASELINE * STEPS_PER_PIXEL)
    parallax = np.float32(focal * BASELINE)
    mask = FIELD - 1
    fresh, lasting = np.float32(FRESH), np.float32(np.sqrt(1.0 - FRESH**2))
    for v in range(height):
        noise_v, fresh_v = (v + row) & mask, (v + fresh_row) & mask
        lit_from = np.float32(1e9)
        for u in range(width - 1, -1, -1):
            own = inverse_depth[v, u]
            from_projector = u - parallax * own
            shadowed = from_projector > lit_from + np.float32(SHADOW)
            lit_from = min(lit_from, from_projector)
            noise_u, fresh_u = (u + column) & mask, (u + fresh_column) & mask
            near_v = min(max(v + lateral[noise_v, noise_u, 0], 0), height - 1)
            near_u = min(max(u + lateral[noise_v, noise_u, 1], 0), width - 1)
            inverse = inverse_depth[near_v, near_u]
            if shadowed or inverse < 1.0 / FURTHEST or inverse > 1.0 / NEAREST:
                continue
            if unseen != 0 and labels[near_v, near_u] == unseen:
                continue
            beside = inverse_depth[near_v, max(near_u - 1, 0)]
            above = inverse_depth[max(near_v - 1, 0), near_u]
            jump = max(abs(beside - inverse), abs(above - inverse))
            if jump > EDGE_JUMP * inverse and patches[fresh_v, fresh_u] < EDGE_LOSS:
                continue
            beyond = np.float32(1.0) / inverse - np.float32(0.4)
            deviation = np.float32(0.0012) + np.float32(0.0019) * beyond * beyond
            noise = lasting * axial[noise_v, noise_u] + fresh * axial[fresh_v, fresh_u]
            disparity = steps * inverse * (1 + deviation * inverse * noise)
            depth[v, u] = np.uint16(np.float32(1000.0) * steps / np.rint(disparity))
    return depth
