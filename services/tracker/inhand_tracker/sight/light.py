"""The colour of the light in a picture, by what surrounds the person, and colours without it.

Nothing says what colours a room has; but they differ among each other, and light tints them all
alike. Two estimates of the tint err differently, and their mean less than either: the middle of the
picture's colours, each of which counts by the logarithm of how much of it there is, so that one
wide wall says little more than a cup (compare grey world: Buchsbaum 1980), and the colour of edges
(van de Weijer, Gevers and Gijsenij 2007). Brightness is left alone.
"""

import cv2
import numpy as np

from inhand_tracker.geometry.arrays import Array, Bytes, Flags, Singles
from inhand_tracker.geometry.image import Image
from inhand_tracker.sight.parameters import SightParameters

WIDTH = 160
"""Width in pixels, about, of the smaller picture that is looked at: without the sensor's noise."""
DARKEST, BRIGHTEST = 8.0, 250.0
"""Levels between which each of a pixel's red, green and blue is measured well."""
CELLS = 40
"""Number of cells, each way, of colours in the plane of log(red / green) and log(blue / green)."""
WIDEST = 1.0
"""Greatest logarithm in that plane; what is more colourful counts as so much."""
COMMON_SHARE = 1e-4
"""Share of the picture from which on a colour counts by the logarithm of its share."""
FEWEST_PIXELS = 100
"""Number of well measured pixels, or steps, below which they say nothing."""


def light_tint(image: Image) -> Array:
    """Estimate the light's log(red / green) and log(blue / green), (2,); 0 where nothing says it.

    White light has 0, whatever its brightness.
    """
    if image.colour is None:
        return np.zeros(2)
    small = _smaller(image.colour)
    usable = _well_measured(small)
    return np.asarray(0.5 * (_middle_colour(small[usable]) + _edge_colour(small, usable)))


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


def _smaller(colour: Bytes) -> Singles:
    step = max(1, round(colour.shape[1] / WIDTH))
    size = (max(1, colour.shape[1] // step), max(1, colour.shape[0] // step))
    small = cv2.resize(colour, size, interpolation=cv2.INTER_AREA)
    return np.asarray(small, np.float32) + np.float32(0.5)


def _well_measured(small: Singles) -> Flags:
    red, green, blue = np.moveaxis(small, 2, 0)
    least, most = np.minimum(np.minimum(red, green), blue), np.maximum(np.maximum(red, green), blue)
    return np.asarray((least > DARKEST) & (most < BRIGHTEST))


def _middle_colour(pixels: Singles) -> Array:
    """The middle (2,) of the colours of pixels (N, 3), each by the logarithm of its share."""
    if len(pixels) < FEWEST_PIXELS:
        return np.zeros(2)
    logs = np.log(pixels)
    ratios = np.clip(logs[:, ::2] - logs[:, 1:2], -WIDEST, WIDEST)
    cells = np.minimum((ratios + WIDEST) * (0.5 * CELLS / WIDEST), CELLS - 1).astype(np.int64)
    counts = np.bincount(cells[:, 0] * CELLS + cells[:, 1], minlength=CELLS * CELLS)
    weights = np.log1p(counts / (COMMON_SHARE * len(pixels))).reshape(CELLS, CELLS)
    middles = (np.arange(CELLS) + 0.5) * (2.0 * WIDEST / CELLS) - WIDEST
    red, blue = weights.sum(axis=1) @ middles, weights.sum(axis=0) @ middles
    return np.array([red, blue]) / weights.sum()


def _edge_colour(small: Singles, usable: Flags) -> Array:
    """The colour (2,) of the steps from pixel to pixel of an image (H, W, 3), by their squares."""
    across, down = usable[:, 1:] & usable[:, :-1], usable[1:] & usable[:-1]
    squares = _squares(small[:, 1:] - small[:, :-1], across)
    squares += _squares(small[1:] - small[:-1], down)
    if across.sum() + down.sum() < FEWEST_PIXELS or squares.min() == 0.0:
        return np.zeros(2)
    logs = 0.5 * np.log(squares)
    return np.array([logs[0] - logs[1], logs[2] - logs[1]])


def _squares(steps: Singles, counted: Flags) -> Array:
    """Sum (3,) of the squares of those steps (H, W, 3) that are counted (H, W)."""
    return np.asarray(np.einsum("hwc,hwc,hw->c", steps, steps, counted), np.float64)
