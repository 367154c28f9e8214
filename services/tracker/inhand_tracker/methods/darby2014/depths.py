"""The depth likelihood that Darby et al. 2014, section 7, tried.

Points of the surface that is seen of an object (what faces away is culled) are compared with the
nearest surface that was measured, wherever that is.
"""

import numpy as np
from scipy.spatial import KDTree

from inhand_tracker.geometry.arrays import Array, Singles
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image

FARTHEST_M = 0.05
PIXEL_STEP = 3


class MeasuredSurfaces:
    """The surfaces in a depth image (H, W) in metres, 0 where nothing was measured."""

    def __init__(self, depth: Singles, camera: Intrinsics) -> None:
        self._measured = depth > 0.0
        self._camera = camera
        row, column = np.mgrid[0 : depth.shape[0] : PIXEL_STEP, 0 : depth.shape[1] : PIXEL_STEP]
        kept = self._measured[row, column]
        pixels = np.column_stack((column[kept], row[kept]))
        points = camera.unproject(pixels, depth[row, column][kept].astype(float))
        self._tree = KDTree(points, balanced_tree=False, compact_nodes=False)

    def distances(self, points: Array) -> Array:
        """How far points (..., 3) in the camera frame are from a surface, in metres, (...).

        ``FARTHEST_M`` at the most; NaN where the camera measured nothing in a point's direction.
        """
        pixels = np.rint(np.nan_to_num(self._camera.project(points), nan=-1.0))
        height, width = self._measured.shape
        known = np.all((pixels >= 0) & (pixels < [width, height]), axis=-1)
        column, row = np.where(known[..., None], pixels, 0).astype(np.intp).transpose(2, 0, 1)
        known &= self._measured[row, column]
        distances = np.full(known.shape, np.nan)
        nearest, _ = self._tree.query(points[known], distance_upper_bound=FARTHEST_M)
        distances[known] = np.minimum(nearest, FARTHEST_M)
        return distances


def surfaces_of(image: Image) -> MeasuredSurfaces | None:
    """The surfaces that an image's depth shows; None where there is no depth."""
    if image.depth is None:
        return None
    height, width = image.depth.shape
    return MeasuredSurfaces(image.depth, image.camera.scaled_to(width, height))


def depth_log_weights(distances: Array) -> Array:
    """−Σ of each hypothesis, (P,), from its surface points' distances (P, S), NaN for unknown.

    Σ = mean (d / FARTHEST_M)², from 0 to 1 as that of the edges. A point of which nothing was
    measured takes the mean of those of all hypotheses, and so speaks for none and against none.
    """
    known = np.isfinite(distances)
    if not known.any():
        return np.zeros(len(distances))
    costs = np.square(distances / FARTHEST_M)
    return -np.where(known, costs, costs[known].mean()).mean(axis=1)
