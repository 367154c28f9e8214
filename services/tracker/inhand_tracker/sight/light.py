"""The colour of the light in a picture, by what surrounds the person, and colours without it.

Nothing says what colours a room has; but they differ among each other, and light tints them all
alike. Two estimates of the tint err differently, and their mean less than either: the middle of the
picture's colours, each of which counts by the logarithm of how much of it there is, so that one
wide wall says little more than a cup (compare grey world: Buchsbaum 1980), and the colour of edges
(van de Weijer, Gevers and Gijsenij 2007). Brightness is left alone.
"""

import cv2
import numpy as np

from inhand_tracker.geometry.arrays import Array, Bytes
from inhand_tracker.geometry.image import Image
from inhand_tracker.sight.kernels.count_tints import count_tints
from inhand_tracker.sight.parameters import SightParameters

WIDTH = 160
"""Width in pixels, about, of the smaller picture that is looked at: without the sensor's noise."""
DARKEST, BRIGHTEST = 8, 249
"""Levels from which to which each of a pixel's red, green and blue is measured well."""
CELLS = 40
"""Number of cells, each way, of colours in the plane of log(red / green) and log(blue / green)."""
WIDEST = 1.0
"""Greatest logarithm in that plane; what is more colourful counts as so much."""
COMMON_SHARE = 1e-4
"""Share of the picture from which on a colour counts by the logarithm of its share."""
FEWEST_PIXELS = 100
"""Number of well measured pixels, or steps, below which they say nothing."""
_LEVELS = np.arange(256)
_MEASURED = ((_LEVELS >= DARKEST) & (_LEVELS <= BRIGHTEST)).astype(np.uint8)
_LOGS = np.log(_LEVELS + 0.5)


def light_tint(image: Image) -> Array:
    """Estimate the light's log(red / green) and log(blue / green), (2,); 0 where nothing says it.

    White light has 0, whatever its brightness.
    """
    if image.colour is None:
        return np.zeros(2)
    counts, squares = np.zeros((CELLS, CELLS)), np.zeros(3)
    small = _smaller(image.colour)
    pixels, steps = count_tints(small, _MEASURED, _LOGS, WIDEST, counts, squares)
    tint = np.zeros(2)
    if pixels >= FEWEST_PIXELS:
        tint += 0.5 * _middle_colour(counts, pixels)
    if steps >= FEWEST_PIXELS and squares.min() > 0.0:
        logs = 0.5 * np.log(squares)
        tint += 0.5 * (logs[::2] - logs[1])
    return tint


def light_gains(image: Image, parameters: SightParameters) -> Array:
    """Return the factors (3,) on red, green and blue that take the light's colour away.

    A part of the tint is the room's own: of what lies between red and blue, as daylight and lamps
    differ, ``daylight_trust`` counts, of what lies between these and green ``tint_trust``.
    """
    red, blue = image.once(light_tint)
    daylight = parameters.daylight_trust * 0.5 * (red - blue)
    tint = parameters.tint_trust * 0.5 * (red + blue)
    logs = np.array([tint + daylight, 0.0, tint - daylight])
    return np.asarray(np.exp(logs.mean() - logs))


def under_white_light(colour: Bytes, gains: Array) -> Bytes:
    """Multiply red, green and blue of an image (H, W, 3) by factors (3,)."""
    levels = np.arange(256.0)[:, None] * gains
    table = np.clip(np.rint(levels), 0.0, 255.0).astype(np.uint8)
    return np.asarray(cv2.LUT(np.ascontiguousarray(colour), table[None]), np.uint8)


def _smaller(colour: Bytes) -> Bytes:
    step = max(1, round(colour.shape[1] / WIDTH))
    size = (max(1, colour.shape[1] // step), max(1, colour.shape[0] // step))
    return np.asarray(cv2.resize(colour, size, interpolation=cv2.INTER_AREA), np.uint8)


def _middle_colour(counts: Array, pixels: int) -> Array:
    """The middle (2,) of the colours of pixels in cells (C, C), each by the logarithm of its
    share."""
    weights = np.log1p(counts / (COMMON_SHARE * pixels))
    middles = (np.arange(CELLS) + 0.5) * (2.0 * WIDEST / CELLS) - WIDEST
    red, blue = weights.sum(axis=1) @ middles, weights.sum(axis=0) @ middles
    return np.array([red, blue]) / weights.sum()
