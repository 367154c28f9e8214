"""Colours as histograms: what an object's are, what its surroundings' are, and which is which."""

from dataclasses import dataclass
from functools import lru_cache

import cv2
import numpy as np
from numpy.typing import NDArray

from inhand_tracker.geometry.arrays import Bytes, Singles
from inhand_tracker.sight.kernels.count import count
from inhand_tracker.sight.kernels.quantise import quantise
from inhand_tracker.sight.kernels.smooth import smooth
from inhand_tracker.sight.parameters import DEFAULT_SIGHT, SightParameters

Bins = NDArray[np.uint16]

LEVELS = 16
"""Number of levels of each of red, green and blue."""
BINS = LEVELS**3
REMEMBERED = 64
"""Number of objects' scores by colour that are kept for the next image, in which most colours are
the same."""


@dataclass(frozen=True, eq=False)
class Colours:
    """Histograms (4096,) that sum to 1 of an object and of what is around it; None until some
    pixels of it were seen. ``mixed`` (4096, 2) is that of the outline's pixels: the object's part
    of them and the surroundings', both as shares of the object's area; None until an image
    supported a pose. One is equal to itself alone: it never changes."""

    of_object: Singles | None = None
    around: Singles | None = None
    mixed: Singles | None = None


def colour_bins(colour: Bytes) -> Bins:
    """Find the histogram bin (H, W) of each pixel of an RGB image (H, W, 3)."""
    bins = np.empty(colour.shape[:2], np.uint16)
    quantise(colour, bins)
    return bins


def without_noise(colour: Bytes) -> Bytes:
    """Smooth an image (H, W, 3) a little."""
    return np.asarray(cv2.GaussianBlur(colour, (3, 3), 0.0), np.uint8)


def histogram(
    bins: Bins, weights: Singles, parameters: SightParameters = DEFAULT_SIGHT
) -> Singles | None:
    """Make the smoothed histogram (4096,) of pixels' bins (H, W) with weights (H, W); None where
    all weights are 0."""
    counts = np.zeros(BINS, np.float32)
    count(bins, weights, counts)
    total = float(counts.sum())
    return smoothed(counts / np.float32(total), parameters) if total > 0.0 else None


def smoothed(histogram: Singles, parameters: SightParameters = DEFAULT_SIGHT) -> Singles:
    """Spread a histogram (4096,) to neighbouring colours; it still sums to 1."""
    spread = np.empty(BINS, np.float32)
    weight = float(np.exp(-0.5 / parameters.smoothing_levels**2))
    smooth(np.ascontiguousarray(histogram, np.float32), LEVELS, weight, spread)
    return np.asarray(spread / spread.sum(), np.float32)


def blend(old: Singles | None, new: Singles | None, rate: float) -> Singles | None:
    """Mix the old histogram with a share ``rate`` of the new one; where one is None, the other."""
    if old is None or new is None:
        return new if old is None else old
    return np.asarray((1.0 - rate) * old + rate * new, np.float32)


def log_odds_by_colour(colours: Colours, parameters: SightParameters = DEFAULT_SIGHT) -> Singles:
    """Return how many times likelier (log) each colour is on the object than around it, (4096,);
    zeros while either histogram is None."""
    if colours.of_object is None or colours.around is None:
        return np.zeros(BINS, np.float32)
    on_object = colours.of_object + parameters.object_floor
    around = colours.around + parameters.around_floor
    if colours.mixed is not None:
        on_object, around = on_object + colours.mixed[:, 0], around + colours.mixed[:, 1]
    odds = np.log(on_object / around)
    return np.asarray(
        np.clip(odds, -parameters.most_log_odds, parameters.most_log_odds), np.float32
    )


@lru_cache(maxsize=REMEMBERED)
def colour_scores(colours: Colours, parameters: SightParameters = DEFAULT_SIGHT) -> Singles:
    """Return the log-likelihood ratios (4096, 2) of each colour for a pixel's being within and
    beside the object."""
    certainty = parameters.colour_certainty
    within = 1.0 / (1.0 + np.exp(-log_odds_by_colour(colours, parameters)))
    sure = certainty * within + (1.0 - certainty) * (1.0 - within)
    return np.log(2.0 * np.column_stack((sure, 1.0 - sure))).astype(np.float32)
