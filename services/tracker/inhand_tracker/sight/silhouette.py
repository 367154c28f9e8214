"""Where an object at a pose is in an image: the region around it, its surface's depths, and its
share in each pixel."""

import cv2
import numpy as np

from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Flags, Singles
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.shape.kernels.mark_faces import mark_faces
from inhand_tracker.shape.raster import nearest_depths
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.sight.colours import without_noise
from inhand_tracker.sight.frame import Region
from inhand_tracker.sight.parameters import SightParameters


def region_around(
    shape: ObjectShape,
    translation: Array,
    rotation: Array,
    camera: Intrinsics,
    parameters: SightParameters,
) -> Region | None:
    """Find the part of the image that holds an object and its surroundings; None where the object
    is out of the image."""
    pixels = camera.project(rotations.rotate(rotation, shape.vertices) + translation)
    if not np.isfinite(pixels).all():
        return None
    low, high = pixels.min(axis=0), pixels.max(axis=0)
    size = float(np.sqrt(np.prod(high - low)))
    margin = max(parameters.margin_sizes * size / 2.0, parameters.least_margin_pixels)
    if (high < 0.0).any() or (low > [camera.width, camera.height]).any():
        return None
    left, top = (low - margin).tolist()
    right, bottom = (high + margin).tolist()
    return left, top, right, bottom


def silhouette_depths(
    shape: ObjectShape, translation: Array, rotation: Array, camera: Intrinsics
) -> Array:
    """Draw the depth (H, W) of the object's surface in each pixel, infinite beside it."""
    placed = rotations.rotate(rotation, shape.vertices) + translation
    size = camera.height, camera.width
    return nearest_depths(camera.project(placed), placed[:, 2], shape.faces, size)


def object_shares(
    shape: ObjectShape, translation: Array, rotation: Array, camera: Intrinsics
) -> Singles:
    """Return the share (H, W), from 0 to 1, of the object in each pixel's colour of an image
    ``without_noise``: at its outline colours are mixed."""
    placed = rotations.rotate(rotation, shape.vertices) + translation
    mask = np.zeros((camera.height, camera.width), np.uint8)
    mark_faces(camera.project(placed), shape.faces, mask)
    return without_noise(255 * mask).astype(np.float32) / np.float32(255.0)


def weights_of_sides(shares: Singles, hidden: Flags, beside: Flags) -> tuple[Singles, Singles]:
    """Weigh pixels (H, W) for the colours of an object and of its surroundings, by the object's
    ``shares`` (H, W) in them.

    ``hidden`` pixels are not the object's; of those without a share in it, the ones ``beside`` it
    are surroundings. The rest of a mixed pixel is the surroundings', in the ratio of both areas, so
    that a colour that is half the object's says nothing.
    """
    of_object = np.where(hidden, np.float32(0.0), shares)
    around = (beside & (shares == 0.0)).astype(np.float32)
    ratio = np.float32(around.sum() / max(float(of_object.sum()), 1.0))
    mixed = (shares > 0.0) & (shares < 1.0) & ~hidden
    return of_object, np.where(mixed, ratio * (np.float32(1.0) - shares), around)


def pixels_covered(measured: Singles | None, depths: Array, aside_m: float) -> Flags:
    """Find the pixels (H, W) where a depth was ``measured`` (H, W) that is nearer than the
    surface's ``depths`` by more than ``aside_m``."""
    if measured is None:
        return np.zeros(depths.shape, bool)
    return (measured > 0.0) & (measured < depths - aside_m)


def interior(silhouette: Flags) -> Flags:
    """Take its rim, where depth is often missing, off a silhouette; a thin one stays whole."""
    inner = cv2.erode(silhouette.astype(np.uint8), np.ones((3, 3))).astype(bool)
    return inner if inner.any() else silhouette
