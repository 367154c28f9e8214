"""How far every pixel is from an edge of a given direction.

An edge counts for a boundary only where both run the same way (oriented chamfer matching, Shotton
et al. 2008): that separates an object's edges from clutter.
"""

import math
from functools import cache

import cv2
import numpy as np

from inhand_tracker.geometry.arrays import Array, Bytes, Singles
from inhand_tracker.sight.kernels.mark_edges import find_distances, mark_edges, score_distances
from inhand_tracker.sight.parameters import DEFAULT_SIGHT, SightParameters

CHANNELS = 4
"""Number of channels: normals to the right, down to the right, down, and down to the left."""
DOWN = 2
"""The channel of normals down."""
COUNTED_LINES = 9
"""Number of lines of pixels of which one is counted to tell how common edges are."""
FARTHEST_PIXELS = 7
"""The greatest distance from an edge that is distinguished, in pixels: the scores' columns."""


def edge_distances(grey: Bytes, parameters: SightParameters = DEFAULT_SIGHT) -> Bytes:
    """Find how many pixels away the next edge of each channel is, (4, H, W); 7 for far.

    ``grey`` (H, W) has little noise.
    """
    across, down = cv2.spatialGradient(grey)
    height, width = grey.shape
    edges = np.zeros((height + 2, width + 2), np.uint8)
    mark_edges(
        np.asarray(across, np.int16),
        np.asarray(down, np.int16),
        parameters.edge_gradient,
        math.cos(math.radians(parameters.edge_agreement_deg)),
        edges,
    )
    distances = np.empty((CHANNELS, height, width), np.uint8)
    find_distances(edges, FARTHEST_PIXELS, distances)
    return distances


def edge_scores(distances: Bytes, parameters: SightParameters = DEFAULT_SIGHT) -> Singles:
    """Return log p(distance | a boundary is here) / p(distance | anywhere) in a frame, (4, 8).

    A share of a boundary's points shows an edge within about a pixel; the rest is like anywhere.
    Where edges are everywhere, they say little.
    """
    scores = np.empty((CHANNELS, FARTHEST_PIXELS + 1), np.float32)
    near = _near(parameters.matched_pixels)
    score_distances(distances, (DOWN, COUNTED_LINES), parameters.matched_share, near, scores)
    return scores


@cache
def _near(matched_pixels: float) -> Array:
    """The probability (8,) of each distance where an edge is about ``matched_pixels`` away."""
    near = np.exp(-np.square(np.arange(FARTHEST_PIXELS + 1) / matched_pixels) / 2.0)
    return np.asarray(near / near.sum())
