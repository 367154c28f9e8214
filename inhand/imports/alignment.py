"""Depth of one camera of a device as another camera beside it sees it.

What RealSense and Azure Kinect record is what each sensor saw, from its own place and through its
own lens; a frame of ours has one view. The z along the other camera's axis is computed anew, as by
Azure Kinect's SDK; that of RealSense passes the number on as it is.
"""

from dataclasses import dataclass

import cv2
import numpy as np
from inhand_runtime.errors import InhandError
from inhand_schemas.messages import CameraInfo
from numpy.typing import NDArray

Floats = NDArray[np.float64]
OVERLAP_PX = 0.25
"""Pixels by which the square that a pixel of depth covers is larger than it is: between two pixels
of a slanted surface no row of pixels may stay without depth."""
CLOSEST_M = 0.01
"""Metres before a camera within which nothing is projected."""
MOST_UNDISTORTION_PX = 0.5
"""Pixels by which a ray may miss its pixel where a lens cannot be inverted: beyond, at the far
corners of wide lenses, depth is left out."""
_ITERATIONS = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 100, 1e-9)


@dataclass(frozen=True)
class DepthAlignment:
    """Makes depth of one view depth of another one.

    ``rays`` (H + 1, W + 1, 2) are x and y at a distance of 1 of the corners of the depth's pixels,
    NaN where the lens cannot be inverted. ``rotation`` (3, 3) and ``translation`` (3,) in metres
    take points of the depth camera to the other one, whose ``view`` it is.
    """

    rays: Floats
    rotation: Floats
    translation: Floats
    view: CameraInfo
    depth_scale: float
    widest: float

    def __call__(self, depth: NDArray[np.uint16]) -> NDArray[np.uint16]:
        """Return the depth (H, W), in its units, as the other view's, 0 where nothing is seen.

        The nearest surface hides those behind it. Raises InhandError for an image of another size.
        """
        if depth.shape != (self.rays.shape[0] - 1, self.rays.shape[1] - 1):
            height, width = (length - 1 for length in self.rays.shape[:2])
            raise InhandError(
                f"depth is {depth.shape[1]} × {depth.shape[0]}, and its calibration is of "
                f"{width} × {height}"
            )
        rows, columns = np.nonzero(depth)
        metres = depth[rows, columns].astype(np.float64) * self.depth_scale
        first, nearest = self._project(self.rays[rows, columns], metres)
        last, farther = self._project(self.rays[rows + 1, columns + 1], metres)
        units = np.round(0.5 * (nearest + farther) / self.depth_scale)
        begin = np.ceil(np.minimum(first, last) - OVERLAP_PX)
        end = np.floor(np.maximum(first, last) + OVERLAP_PX)
        size = np.array([self.view.width, self.view.height])
        shown = np.isfinite(begin + end).all(axis=1) & (units < np.iinfo(np.uint16).max)
        shown[shown] = ((end[shown] >= 0) & (begin[shown] < size)).all(axis=1)
        return self._nearest(
            np.maximum(begin[shown], 0).astype(int),
            np.minimum(end[shown], size - 1).astype(int),
            units[shown].astype(np.uint16),
        )

    def _project(self, rays: Floats, metres: Floats) -> tuple[Floats, Floats]:
        """Return pixels (N, 2) of the other view, NaN for what it cannot see, and z (N,)."""
        points = np.column_stack((rays * metres[:, None], metres)) @ self.rotation.T
        points += self.translation
        z = points[:, 2]
        with np.errstate(divide="ignore", invalid="ignore"):
            seen = (z > CLOSEST_M) & (np.hypot(points[:, 0], points[:, 1]) < self.widest * z)
        pixels = np.full((len(points), 2), np.nan)
        if seen.any():
            pixels[seen] = project(points[seen], self.view)
        return pixels, z

    def _nearest(
        self, begin: NDArray[np.int_], end: NDArray[np.int_], units: NDArray[np.uint16]
    ) -> NDArray[np.uint16]:
        """Return the least of ``units`` (N,) over squares from ``begin`` to ``end`` (N, 2)."""
        farthest = np.iinfo(np.uint16).max
        shape = self.view.height, self.view.width
        drawn = np.full(shape, farthest, np.uint16)
        extent = end - begin
        for down in range(int(extent[:, 1].max(initial=-1)) + 1):
            for right in range(int(extent[:, 0].max(initial=-1)) + 1):
                covers = (extent[:, 0] >= right) & (extent[:, 1] >= down)
                places = begin[covers, 1] + down, begin[covers, 0] + right
                np.minimum.at(drawn, places, units[covers])
        return np.where(drawn == farthest, 0, drawn).astype(np.uint16)


def align_depth(
    depth: CameraInfo, view: CameraInfo, rotation: Floats, translation: Floats
) -> DepthAlignment:
    """Prepare to align a depth camera's images to a view; ``depth_scale`` is that of ``depth``.

    ``rotation`` (3, 3) and ``translation`` (3,) in metres take points from one to the other.
    """
    columns, rows = np.meshgrid(np.arange(depth.width + 1), np.arange(depth.height + 1))
    corners = np.stack((columns, rows), axis=-1).astype(np.float64) - 0.5
    places = [np.linspace(0.0, length, 9) for length in (view.width, view.height)]
    border: Floats = np.stack(np.meshgrid(*places), axis=-1).reshape(-1, 2)
    widest = float(np.nanmax(np.hypot(*unproject(border - 0.5, view).T)))
    rays = unproject(corners.reshape(-1, 2), depth).reshape(corners.shape)
    return DepthAlignment(rays, rotation, translation, view, depth.depth_scale, 1.05 * widest)


def project(points: Floats, camera: CameraInfo) -> Floats:
    """Return the pixels (N, 2) of points (N, 3) before a camera, through its lens."""
    zero, distortion = np.zeros(3), np.array(camera.distortion)
    pixels, _ = cv2.projectPoints(points.reshape(-1, 1, 3), zero, zero, _matrix(camera), distortion)
    return np.asarray(pixels, np.float64).reshape(-1, 2)


def unproject(pixels: Floats, camera: CameraInfo) -> Floats:
    """Return x and y at a distance of 1 (N, 2) of pixels (N, 2); NaN where the lens cannot be
    inverted."""
    rays = cv2.undistortPoints(
        pixels.reshape(-1, 1, 2),
        _matrix(camera),
        np.array(camera.distortion),
        criteria=_ITERATIONS,
    ).reshape(-1, 2)
    found = project(np.column_stack((rays, np.ones(len(rays)))), camera)
    missed = ~(np.abs(found - pixels).max(axis=1) < MOST_UNDISTORTION_PX)
    rays[missed] = np.nan
    return np.asarray(rays, np.float64)


def _matrix(camera: CameraInfo) -> Floats:
    return np.array([[camera.fx, 0.0, camera.cx], [0.0, camera.fy, camera.cy], [0.0, 0.0, 1.0]])
