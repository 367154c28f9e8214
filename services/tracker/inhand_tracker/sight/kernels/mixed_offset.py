"""Where an outline lies to a fraction of a pixel, by how the colours on its two sides mix there.

A pixel that the outline runs through has the object's share of the one colour, and the rest of the
other: the shares along a line across the outline add up to how far the object reaches on it.
"""

from typing import NamedTuple

import numpy as np
from inhand_runtime.compiled import njit

from inhand_tracker.geometry.arrays import Array, Bytes
from inhand_tracker.sight.kernels.equations import FAST
from inhand_tracker.sight.kernels.inputs import ScoredPixels

SAMPLES = 13
"""Number of samples on a line."""
BLURRED_PIXELS = 1.25
"""Distance from the outline, on either side, within which colours mix."""


class Mixing(NamedTuple):
    """Numbers of ``SightParameters``: how far a line goes to either side, in pixels, the least
    width in pixels of an object and of the gap beside it, the least contrast of their colours, in
    grey levels, the variance of an offset, in pixels², and how much more it counts than one by
    histograms."""

    reach_pixels: float
    least_pixels: float
    contrast: float
    variance: float
    gain: float


@njit(cache=True, nogil=True, fastmath=FAST)
def mixed_offset(
    line: tuple[float, float, float, float],
    sides: tuple[float, float],
    pixels: ScoredPixels,
    mixing: Mixing,
) -> tuple[float, float]:
    """Return how far outside the ``line``'s (u, v, and its normal) middle the outline lies, and the
    variance, in pixels; infinite where the line leaves the image, or the colours on its two sides
    are alike, or not the object's within and its surroundings' beside.

    The object and the gap beside it are as wide as its ``sides``, in pixels.
    """
    u, v, nx, ny = line
    inwards = min(sides[0] - 0.75, mixing.reach_pixels)
    outwards = min(sides[1] - 0.75, mixing.reach_pixels)
    height, width = pixels.limbs.shape
    for away in (-inwards, outwards):
        x, y = u + away * nx, v + away * ny
        if not (x >= 1.0 and y >= 1.0 and x < width - 1.0 and y < height - 1.0):
            return 0.0, np.inf
    step = (inwards + outwards) / (SAMPLES - 1)
    colours = np.empty((SAMPLES, 3))
    within, beside = np.zeros(3), np.zeros(3)
    of_within = of_beside = within_odds = beside_odds = 0.0
    for sample in range(SAMPLES):
        away = sample * step - inwards
        x, y = u + away * nx, v + away * ny
        _interpolate(pixels.colour, x - 0.5, y - 0.5, colours[sample])
        scores = pixels.colour_scores[int(y), int(x)]
        if away <= -BLURRED_PIXELS:
            within += colours[sample]
            within_odds += scores[0] - scores[1]
            of_within += 1.0
        elif away >= BLURRED_PIXELS:
            beside += colours[sample]
            beside_odds += scores[0] - scores[1]
            of_beside += 1.0
    if within_odds < 0.0 or beside_odds > 0.0:
        return 0.0, np.inf
    within /= of_within
    beside /= of_beside
    across = within - beside
    contrast = (across * across).sum()
    if contrast < mixing.contrast * mixing.contrast:
        return 0.0, np.inf
    reached = strange = 0.0
    for sample in range(SAMPLES):
        off = colours[sample] - beside
        share = (off * across).sum() / contrast
        # What is no mixture of the two is another thing.
        strange += (off * off).sum() / contrast - share * share
        ends = 0.5 if sample in (0, SAMPLES - 1) else 1.0
        reached += ends * min(max(share, -0.25), 1.25)
    offset = step * reached - inwards
    return offset, mixing.variance + 2.0 * strange / SAMPLES + 0.1 * offset * offset


@njit(cache=True, nogil=True, inline="always", fastmath=FAST)
def _interpolate(image: Bytes, x: float, y: float, colour: Array) -> None:
    """Fill ``colour`` (3,) with an image's (H, W, 3) at x and y, which are 0 in the middle of the
    first pixel."""
    height, width, _ = image.shape
    column, row = min(int(x), width - 2), min(int(y), height - 2)
    right, down = x - column, y - row
    left, up = 1.0 - right, 1.0 - down
    for channel in range(3):
        above = left * image[row, column, channel] + right * image[row, column + 1, channel]
        below = left * image[row + 1, column, channel] + right * image[row + 1, column + 1, channel]
        colour[channel] = up * above + down * below
