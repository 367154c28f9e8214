"""Records of arrays that kernels read: an object's outlines, a frame's pixels, the sensor."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from inhand_tracker.geometry.arrays import Bytes, Singles


class Outlines(NamedTuple):
    """``Contours`` with the coordinate before the point, (V, 3, B), so that points are weighed
    several at once.

    ``grid`` finds the nearest direction (``view_grid``); ``sizes`` (V,) is the square root of the
    areas, and ``lengths`` (V,) are those of the outlines, as shares of their mean.
    """

    grid: NDArray[np.int16]
    directions: Singles
    points: Singles
    normals: Singles
    inside: Singles
    outside: Singles
    surface_points: Singles
    surface_normals: Singles
    sizes: Singles
    lengths: Singles


class ScoredPixels(NamedTuple):
    """A frame's pixels with the scores of one object's colours: ``lens`` (fx, fy, cx, cy),
    distances to ``edges`` (4, H, W) with ``edge_scores`` (4, 8), ``colour_scores`` (H, W, 2) for a
    pixel's being within or beside the object, ``limbs`` (H, W), ``depth`` (H, W) and ``colour``
    (H, W, 3)."""

    lens: Singles
    edges: Bytes
    edge_scores: Singles
    colour_scores: Singles
    limbs: Bytes
    depth: Singles
    colour: Bytes


class Sensor(NamedTuple):
    """How depth is measured: the noise's deviation ``noise_m`` close by and its growth
    ``noise_per_m`` with the square of the depth, and ``covered_m``, by how much more than twice
    that deviation a nearer measurement covers a point."""

    noise_m: np.float32
    noise_per_m: np.float32
    covered_m: np.float32
