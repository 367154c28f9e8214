"""The depth likelihood that Darby et al. 2014, section 7, tried.

Points of the surface that is seen of an object (what faces away is culled) are compared with the
nearest surface that was measured, wherever that is.
"""

import numpy as np
from scipy.spatial import KDTree

from inhand_tracker.geometry.arrays import Array, Singles
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image
from inhand_tracker.methods.darby2014.parameters import DEFAULT_SURFACE, SurfaceParameters


class MeasuredSurfaces:
    """The surfaces in a depth image (H, W) in metres, 0 where nothing was measured."""

    def __init__(
        self, depth: Singles, camera: Intrinsics, parameters: SurfaceParameters = DEFAULT_SURFACE
    ) -> None:
        self._measured = depth > 0.0
        self._camera = camera
        self._farthest_m = parameters.farthest_surface_m
        step = parameters.pixel_step
        row, column = np.mgrid[0 : depth.shape[0] : step, 0 : depth.shape[1] : step]
        kept = self._measured[row, column]
        pixels = np.column_stack((column[kept], row[kept]))
        points = camera.unproject(pixels, depth[row, column][kept].astype(float))
        self._tree = KDTree(points, balanced_tree=False, compact_nodes=False)

    def distances(self, points: Array) -> Array:
        """Distances in metres, (...), of points (..., 3) in the camera frame from a surface.

        ``farthest_surface_m`` at the most; NaN where the camera measured nothing in a point's
        direction.
        """
        pixels = np.rint(np.nan_to_num(self._camera.project(points), nan=-1.0))
        height, width = self._measured.shape
        measured = np.all((pixels >= 0) & (pixels < [width, height]), axis=-1)
        column, row = np.where(measured[..., None], pixels, 0).astype(np.intp).transpose(2, 0, 1)
        measured &= self._measured[row, column]
        distances = np.full(measured.shape, np.nan)
        nearest, _ = self._tree.query(points[measured], distance_upper_bound=self._farthest_m)
        distances[measured] = np.minimum(nearest, self._farthest_m)
        return distances


def surfaces_of(image: Image) -> MeasuredSurfaces | None:
    """The surfaces that an image's depth shows; None where there is no depth."""
    if image.depth is None:
        return None
    height, width = image.depth.shape
    return MeasuredSurfaces(image.depth, image.camera.scaled_to(width, height))


def depth_log_weights(distances: Array, parameters: SurfaceParameters = DEFAULT_SURFACE) -> Array:
    """−Σ of each hypothesis, (P,), from its surface points' distances (P, S), NaN for unknown.

    Σ = mean (d / farthest)², from 0 to 1 as that of the edges. A point of which nothing was
    measured takes the mean of those of all hypotheses, and so speaks for none and against none.
    """
    measured = np.isfinite(distances)
    if not measured.any():
        return np.zeros(len(distances))
    costs = np.square(distances / parameters.farthest_surface_m)
    return -np.where(measured, costs, costs[measured].mean()).mean(axis=1)
