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

from inhand.imports.kernels.depth_alignment import NOTHING, draw_depth

Floats = NDArray[np.float64]
OVERLAP_PX = 0.25
"""Pixels by which the square that a pixel of depth covers is larger than it is: between two pixels
of a slanted surface no row of pixels may stay without depth."""
CLOSEST_M = 0.01
"""Metres before a camera within which nothing is projected."""
BEYOND = 1.05
"""Share of the farthest ray from a view's axis in its image beyond which nothing is projected:
what a lens's distortion means is known in the image alone."""
MOST_UNDISTORTION_PX = 0.5
"""Pixels by which a ray may miss its pixel where a lens cannot be inverted: beyond, at the far
corners of wide lenses, depth is left out."""
_ITERATIONS = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 100, 1e-9)


@dataclass(frozen=True)
class DepthAlignment:
    """Makes depth of one view depth of another one.

    ``rays`` (H + 1, W + 1, 2) are x and y at a distance of 1 of the corners of the depth's pixels,
    NaN where the lens cannot be inverted. ``motion`` (3, 4) takes points of the depth camera to the
    other one, in metres, whose ``view`` it is; ``widest`` is how far from its axis it sees.
    """

    rays: Floats
    motion: Floats
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
        view, limits = self.view, (self.depth_scale, CLOSEST_M, OVERLAP_PX)
        lens = np.array([view.fx, view.fy, view.cx, view.cy])
        drawn = np.full((view.height, view.width), NOTHING, np.uint16)
        seen = lens, _distortion(view), self.widest
        draw_depth(np.ascontiguousarray(depth), self.rays, self.motion, seen, limits, drawn)
        drawn[drawn == NOTHING] = 0
        return drawn


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
    motion = np.column_stack((rotation, translation))
    return DepthAlignment(rays, motion, view, depth.depth_scale, BEYOND * widest)


def _distortion(camera: CameraInfo) -> Floats:
    """Return the distortion (8,) as OpenCV orders it; raises InhandError for a lens with more."""
    numbers = np.zeros(14)
    numbers[: len(camera.distortion)] = camera.distortion
    if numbers[8:].any():
        raise InhandError("a lens with thin prisms or a tilted sensor is not aligned to")
    return numbers[:8]


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
