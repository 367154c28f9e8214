"""The point that a person clicks on in an image: where depth was measured there."""

import numpy as np
from inhand_tracker.geometry.arrays import Array, Singles
from inhand_tracker.geometry.image import Image

from inhand_lab.labelling.keyframes import LabellingError
from inhand_lab.labelling.parameters import DEFAULT_LABELLING, LabellingParameters


def point_at(
    image: Image, pixel: Array, parameters: LabellingParameters = DEFAULT_LABELLING
) -> Array:
    """Return the point (3,) in the camera's frame, in metres, that is seen at a ``pixel`` (2,).

    The pixel is x and y in the image of ``image.camera``. Raises LabellingError for one that is
    outside, and where no depth was measured near it.
    """
    return points_near(image, pixel, parameters)[0]


def points_near(
    image: Image, pixel: Array, parameters: LabellingParameters = DEFAULT_LABELLING
) -> Array:
    """Return the points (S, 3) at a pixel of the S surfaces that are seen around it.

    First comes that at the pixel itself, then the others, the nearest first: who clicks on an edge
    may miss it. Raises LabellingError as ``point_at`` does.
    """
    pixel = np.asarray(pixel, float)
    camera, place = image.camera, f"({pixel[0]:.0f}, {pixel[1]:.0f})"
    inside = (pixel >= -0.5).all() and (pixel < [camera.width - 0.5, camera.height - 0.5]).all()
    if not inside:
        raise LabellingError(
            f"pixel {place} is outside the image of {camera.width} × {camera.height}: click in it"
        )
    if image.depth is None:
        raise LabellingError("this frame has no depth: choose a frame that has")
    height, width = image.depth.shape
    scaled = camera.scaled_to(width, height)
    at = (pixel + 0.5) * [width / camera.width, height / camera.height] - 0.5
    depths = _surfaces(image.depth, at, parameters)
    if not depths:
        raise LabellingError(
            f"no depth was measured around pixel {place}: click where the surface is matt, or in "
            "another frame"
        )
    return scaled.unproject(np.tile(at, (len(depths), 1)), np.array(depths))


def _surfaces(depths: Singles, at: Array, parameters: LabellingParameters) -> list[float]:
    """Return the depths in metres of the surfaces around a pixel, as ``points_near`` orders them.

    Depths that follow each other closely are of one surface; a few stray ones make none.
    """
    column, row = np.rint(at).astype(int)
    reach = parameters.click_pixels
    rows = slice(max(row - reach, 0), row + reach + 1)
    columns = slice(max(column - reach, 0), column + reach + 1)
    around = np.sort(depths[rows, columns], axis=None).astype(float)
    around = around[np.isfinite(around) & (around > 0.0)]
    if not len(around):
        return []
    groups = np.split(around, np.flatnonzero(np.diff(around) > parameters.click_depth_m) + 1)
    surfaces = [one for one in groups if len(one) >= parameters.click_share * len(around)]
    here = float(depths[row, column])
    at_pixel = [one for one in surfaces if one[0] <= here <= one[-1]]
    # A surface that is seen aslant has many depths; those at the pixel are like its own.
    first = [
        float(np.median(one[np.abs(one - here) <= parameters.click_depth_m])) for one in at_pixel
    ]
    others = [float(np.median(one)) for one in surfaces if not (one[0] <= here <= one[-1])]
    return [*first, *others] or [float(np.median(around))]
