"""Depth as the two grey cameras of an OAK-D measure it.

Disparity is searched up to 95 pixels of a camera whose focal length is 882.5 pixels, with a
baseline of 7.5 cm, in steps of one eighth of a pixel (Luxonis, *Configuring Stereo Depth*): nothing
is nearer than 0.70 m. A quarter of a pixel of matching noise makes an error that grows with the
square of the distance, 1.5 cm at 2 m and 6 cm at 4 m; the maker promises less than 2 % up to 4 m
(median). The matching window blurs outlines, the left-right check discards what one of the two
does not see, and where nothing is drawn on a surface there is nothing to match. How bare
surfaces are is assumed: walls and floors often, clothes rarely.
"""

from __future__ import annotations

import numba
import numpy as np
from inhand_tracker.geometry.camera import Intrinsics
from numpy.typing import NDArray

from inhand_lab.geometry.rasteriser import Canvas
from inhand_lab.sensing.noise_fields import FIELD, NoiseFields, Place, noise_fields
from inhand_lab.sensing.render import PERSON, ROOM

BASELINE = 0.075
FOCAL_LENGTH = 882.5
STEPS_PER_PIXEL = 8.0
MOST_DISPARITY = 95.0
FURTHEST = 12.0
MATCHING_DEVIATION = 0.25
"""Pixels of disparity."""
FRESH = 0.6
"""Share of the deviation that is new in every frame: unlike projected dots, shot noise is."""
LATERAL_DEVIATION = 1.6
EDGE_JUMP = 0.04
EDGE_LOSS = 0.5
BARE_WALLS, BARE_CLOTHES, BARE_THINGS = 0.20, 0.04, 0.10
"""Shares of the surface without texture."""
WINDOW = 15
FAINT = 0.5
"""A mean change of brightness from pixel to pixel in WINDOW pixels, in levels of 256, that is
enough to match even on a bare surface."""


def measure(
    canvas: Canvas, intrinsics: Intrinsics, unseen: int, lasting: Place, fresh: Place
) -> NDArray[np.uint16]:
    """Depth (H, W) in millimetres, 0 where nothing was measured.

    unseen is the label of what cannot be matched, 0 if all can. Noise is looked up from two
    places: one lasts as long as the camera stands still, the other is of this frame.
    """
    fields = _fields()
    depth = _measure(
        canvas.colour,
        canvas.inverse_depth,
        canvas.labels,
        unseen,
        intrinsics.fx,
        fields.axial,
        fields.lateral,
        fields.loss,
        fields.patches,
        *lasting,
        *fresh,
    )
    return np.asarray(depth)


def _fields() -> NoiseFields:
    return noise_fields(2.5, LATERAL_DEVIATION, 12.0)


@numba.njit(cache=True, nogil=True)
def _measure(  # type: ignore[no-untyped-def]
    colour,
    inverse_depth,
    labels,
    unseen,
    focal,
    axial,
    lateral,
    loss,
    patches,
    row,
    column,
    fresh_row,
    fresh_column,
):
    height, width = inverse_depth.shape
    depth = np.zeros((height, width), np.uint16)
    steps = np.float32(FOCAL_LENGTH * BASELINE * STEPS_PER_PIXEL)
    parallax = np.float32(0.5 * focal * BASELINE)
    least, most = np.float32(1.0 / FURTHEST), np.float32(MOST_DISPARITY / FOCAL_LENGTH / BASELINE)
    mask = FIELD - 1
    deviation = np.float32(MATCHING_DEVIATION * STEPS_PER_PIXEL)
    fresh, lasting = np.float32(FRESH), np.float32(np.sqrt(1.0 - FRESH**2))
    person_v, person_u = _middle(labels)
    hidden = np.empty(width, np.bool_)
    drawn = np.empty(width, np.bool_)
    for v in range(height):
        _find_hidden(inverse_depth[v], parallax, hidden)
        _find_drawn(colour[v], drawn)
        noise_v, fresh_v = (v + row) & mask, (v + fresh_row) & mask
        for u in range(width):
            noise_u, fresh_u = (u + column) & mask, (u + fresh_column) & mask
            near_v = min(max(v + lateral[fresh_v, fresh_u, 0], 0), height - 1)
            near_u = min(max(u + lateral[fresh_v, fresh_u, 1], 0), width - 1)
            inverse = inverse_depth[near_v, near_u]
            label = labels[near_v, near_u]
            if hidden[u] or inverse < least or inverse > most:
                continue
            if unseen != 0 and label == unseen:
                continue
            if not drawn[u]:
                if label == ROOM:
                    if patches[noise_v, noise_u] < BARE_WALLS:
                        continue
                else:
                    bare = BARE_CLOTHES if label == PERSON else BARE_THINGS
                    if patches[(v - person_v) & mask, (u - person_u) & mask] < bare:
                        continue
            beside = inverse_depth[near_v, max(near_u - 1, 0)]
            above = inverse_depth[max(near_v - 1, 0), near_u]
            jump = max(abs(beside - inverse), abs(above - inverse))
            if jump > EDGE_JUMP * inverse and loss[fresh_v, fresh_u] < EDGE_LOSS:
                continue
            noise = lasting * axial[noise_v, noise_u] + fresh * axial[fresh_v, fresh_u]
            disparity = max(np.rint(steps * inverse + deviation * noise), np.float32(1.0))
            depth[v, u] = np.uint16(min(np.float32(1000.0) * steps / disparity, 65535.0))
    return depth


@numba.njit(cache=True, nogil=True)
def _middle(labels):  # type: ignore[no-untyped-def]
    """The mean pixel of the person, that patches of clothing go with."""
    height, width = labels.shape
    count, rows, columns = 0, 0, 0
    for v in range(height):
        for u in range(width):
            if labels[v, u] == PERSON:
                count += 1
                rows += v
                columns += u
    return (rows // count, columns // count) if count else (0, 0)


@numba.njit(cache=True, nogil=True)
def _find_hidden(inverse_depth, parallax, hidden):  # type: ignore[no-untyped-def]
    """Pixels of a row that the right or the left camera does not see for something nearer."""
    width = len(inverse_depth)
    seen_to = np.float32(1e9)
    for u in range(width - 1, -1, -1):
        place = u - parallax * inverse_depth[u]
        hidden[u] = place > seen_to + np.float32(1.0)
        seen_to = min(seen_to, place)
    seen_to = np.float32(-1e9)
    for u in range(width):
        place = u + parallax * inverse_depth[u]
        hidden[u] |= place < seen_to - np.float32(1.0)
        seen_to = max(seen_to, place)


@numba.njit(cache=True, nogil=True)
def _find_drawn(colour, drawn):  # type: ignore[no-untyped-def]
    """Pixels of a row in a window of enough changes of brightness to be matched."""
    width = len(drawn)
    half = WINDOW // 2
    changes = 0
    for u in range(-half, width):
        changes += _change(colour, u + half) - _change(colour, u - half - 1)
        if u >= 0:
            drawn[u] = changes > FAINT * WINDOW


@numba.njit(cache=True, nogil=True)
def _change(colour, u):  # type: ignore[no-untyped-def]
    """Of green from the pixel before in a row, 0 outside it."""
    if u < 1 or u >= len(colour):
        return np.int32(0)
    return abs(np.int32(colour[u, 1]) - np.int32(colour[u - 1, 1]))
