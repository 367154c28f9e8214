"""Depth as the two grey cameras of an OAK-D measure it.

Disparity is searched up to 95 pixels of a camera whose focal length is 882.5 pixels, with a
baseline of 7.5 cm, in steps of one eighth of a pixel (Luxonis, *Configuring Stereo Depth*): nothing
is nearer than 0.70 m. A quarter of a pixel of matching noise makes an error that grows with the
square of the distance, 1.5 cm at 2 m and 6 cm at 4 m; the maker promises less than 2 % up to 4 m
(median). The matching window blurs outlines, the left-right check discards what one of the two
does not see, and where a surface shows no texture there is nothing to match. How bare
surfaces are is assumed: walls and floors often, clothes rarely.
"""

from __future__ import annotations

import numpy as np
from inhand_runtime.compiled import njit
from numpy.typing import NDArray

from inhand_lab.sensing.depth_scene import (
    DepthScene,
    displaced,
    fields_for,
    looked_up,
    mixed,
    steepest,
    steps_at_one_metre,
)
from inhand_lab.sensing.noise_fields import FIELD
from inhand_lab.sensing.noise_parameters import StereoNoise
from inhand_lab.sensing.render import PERSON, ROOM


def measure_stereo_depth(scene: DepthScene, noise: StereoNoise) -> NDArray[np.uint16]:
    """Measure two grey cameras' depth (H, W), millimetres, 0 where nothing was measured."""
    return np.asarray(_measure(scene, fields_for(noise), noise))


@njit(cache=True, nogil=True)
def _measure(scene, fields, noise):  # type: ignore[no-untyped-def]
    inverse_depth = scene.inverse_depth
    height, width = inverse_depth.shape
    depth = np.zeros((height, width), np.uint16)
    steps = steps_at_one_metre(noise)
    parallax = np.float32(0.5 * scene.focal * noise.baseline)
    least = np.float32(1.0 / noise.furthest)
    most = np.float32(noise.most_disparity / noise.focal_length / noise.baseline)
    deviation = np.float32(noise.matching_deviation * noise.steps_per_pixel)
    person = _middle(scene.labels)
    hidden = np.empty(width, np.bool_)
    drawn = np.empty(width, np.bool_)
    for v in range(height):
        _find_hidden(inverse_depth[v], parallax, hidden)
        _find_drawn(scene.colour[v], noise.window, noise.faint, drawn)
        for u in range(width):
            lasting, fresh = looked_up(scene.lasting, v, u), looked_up(scene.fresh, v, u)
            near = displaced(fields.lateral, fresh, v, u, (height, width))
            inverse, label = inverse_depth[near], scene.labels[near]
            if hidden[u] or inverse < least or inverse > most:
                continue
            if scene.unseen != 0 and label == scene.unseen:
                continue
            if not drawn[u] and _bare(fields.patches, label, lasting, (v, u), person, noise):
                continue
            jump = steepest(inverse_depth, near[0], near[1])
            if jump > noise.edge_jump * inverse and fields.loss[fresh] < noise.edge_loss:
                continue
            error = mixed(fields.axial, lasting, fresh, noise.fresh)
            disparity = max(np.rint(steps * inverse + deviation * error), np.float32(1.0))
            depth[v, u] = np.uint16(min(np.float32(1000.0) * steps / disparity, 65535.0))
    return depth


@njit(cache=True, nogil=True)
def _bare(patches, label, lasting, pixel, person, noise):  # type: ignore[no-untyped-def]
    """Whether a pixel's surface is without texture: patches of clothing go with the person."""
    if label == ROOM:
        return patches[lasting] < noise.bare_walls
    mask = FIELD - 1
    share = noise.bare_clothes if label == PERSON else noise.bare_things
    return patches[(pixel[0] - person[0]) & mask, (pixel[1] - person[1]) & mask] < share


@njit(cache=True, nogil=True)
def _middle(labels):  # type: ignore[no-untyped-def]
    """The person's mean pixel, row and column; the first where nobody is seen."""
    height, width = labels.shape
    count, rows, columns = 0, 0, 0
    for v in range(height):
        for u in range(width):
            if labels[v, u] == PERSON:
                count += 1
                rows += v
                columns += u
    return (rows // count, columns // count) if count else (0, 0)


@njit(cache=True, nogil=True)
def _find_hidden(inverse_depth, parallax, hidden):  # type: ignore[no-untyped-def]
    """Find pixels of a row that something nearer hides from the right or the left camera."""
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


@njit(cache=True, nogil=True)
def _find_drawn(colour, window, faint, drawn):  # type: ignore[no-untyped-def]
    """Find pixels of a row in a window of enough changes of brightness to be matched."""
    width = len(drawn)
    half = window // 2
    changes = 0
    for u in range(-half, width):
        changes += _change(colour, u + half) - _change(colour, u - half - 1)
        if u >= 0:
            drawn[u] = changes > faint * window


@njit(cache=True, nogil=True)
def _change(colour, u):  # type: ignore[no-untyped-def]
    """Change of green from the pixel before in a row, 0 outside it."""
    if u < 1 or u >= len(colour):
        return np.int32(0)
    return abs(np.int32(colour[u, 1]) - np.int32(colour[u - 1, 1]))
