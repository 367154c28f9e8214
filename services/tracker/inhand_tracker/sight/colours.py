"""Colours as histograms: what an object's are, what its surroundings' are, and which is which."""

from dataclasses import dataclass

import cv2
import numpy as np
from numba import njit
from numpy.typing import NDArray

from inhand_tracker.geometry.arrays import Bytes, Singles

Bins = NDArray[np.uint16]

LEVELS = 16
"""Of red, green and blue each."""
BINS = LEVELS**3
SMOOTHING_LEVELS = 0.8
FLOOR = 1e-5
FLOOR_AROUND = 2e-5
"""What a colour that was never seen counts as: it is rather of the rest of the world."""
MOST_LOG_ODDS = 3.0


@dataclass(frozen=True)
class Colours:
    """Histograms (4096,) that sum to 1 of an object and of what is around it.

    None where nothing is known yet.
    """

    of_object: Singles | None = None
    around: Singles | None = None


def colour_bins(colour: Bytes) -> Bins:
    """The histogram bin (H, W) of each pixel of an RGB image (H, W, 3), noise smoothed away."""
    smooth = np.asarray(cv2.GaussianBlur(colour, (3, 3), 0.0), np.uint8)
    bins = np.empty(colour.shape[:2], np.uint16)
    _quantise(smooth, bins)
    return bins


def histogram(bins: Bins, weights: Singles) -> Singles | None:
    """The smoothed histogram (4096,) of pixels (H, W) with weights (H, W); None without any."""
    counts = np.zeros(BINS, np.float32)
    _count(bins, weights, counts)
    total = float(counts.sum())
    return smoothed(counts / np.float32(total)) if total > 0.0 else None


def smoothed(histogram: Singles) -> Singles:
    """Spread to neighbouring colours, still summing to 1."""
    cube = histogram.reshape(LEVELS, LEVELS, LEVELS)
    kernel = np.exp(-np.square([-1.0, 0.0, 1.0]) / (2.0 * SMOOTHING_LEVELS**2)).astype(np.float32)
    kernel /= kernel.sum()
    for axis in range(3):
        padded = np.pad(cube, [(1, 1) if a == axis else (0, 0) for a in range(3)], mode="edge")
        parts = [np.take(padded, range(k, k + LEVELS), axis=axis) for k in range(3)]
        cube = kernel[0] * parts[0] + kernel[1] * parts[1] + kernel[2] * parts[2]
    flat = cube.ravel()
    return np.asarray(flat / flat.sum(), np.float32)


def blend(old: Singles | None, new: Singles | None, rate: float) -> Singles | None:
    """The old histogram with a share ``rate`` of the new one; whichever there is."""
    if old is None or new is None:
        return new if old is None else old
    return np.asarray((1.0 - rate) * old + rate * new, np.float32)


def log_odds_by_colour(colours: Colours) -> Singles:
    """(4096,): the log of how many times likelier a colour is on the object than around it.

    Zeros while either is not known.
    """
    if colours.of_object is None or colours.around is None:
        return np.zeros(BINS, np.float32)
    odds = np.log((colours.of_object + FLOOR) / (colours.around + FLOOR_AROUND))
    return np.asarray(np.clip(odds, -MOST_LOG_ODDS, MOST_LOG_ODDS), np.float32)


@njit(cache=True, nogil=True)
def _quantise(colour: Bytes, bins: Bins) -> None:
    for row in range(colour.shape[0]):
        for column in range(colour.shape[1]):
            red, green, blue = colour[row, column]
            bins[row, column] = ((red >> 4) << 8) | ((green >> 4) << 4) | (blue >> 4)


@njit(cache=True, nogil=True)
def _count(bins: Bins, weights: Singles, counts: Singles) -> None:
    for row in range(bins.shape[0]):
        for column in range(bins.shape[1]):
            counts[bins[row, column]] += weights[row, column]


@njit(cache=True, nogil=True)
def look_up(bins: Bins, limbs: Bytes, table: Singles, limb_share: float, scores: Singles) -> None:
    """Fill ``scores`` (H, W, 2) from a table (4096, 2) of what a colour says to a pixel's being
    within and beside an object. Of what speaks against it a share counts where limbs may be."""
    for row in range(bins.shape[0]):
        for column in range(bins.shape[1]):
            within, beside = table[bins[row, column]]
            if limbs[row, column] and within < beside:
                within, beside = within * limb_share, beside * limb_share
            scores[row, column, 0] = within
            scores[row, column, 1] = beside
