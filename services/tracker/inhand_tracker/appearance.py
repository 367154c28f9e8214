"""How an object looks, learned from frames in which it is known where it is."""

from collections.abc import Iterable
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from inhand_tracker import rotations
from inhand_tracker.camera import Intrinsics
from inhand_tracker.colours import BINS, Bins, smoothed
from inhand_tracker.image import Image
from inhand_tracker.raster import nearest_depths
from inhand_tracker.shape import ObjectShape
from inhand_tracker.sight_frame import SightFrame, prepare

Array = NDArray[np.float64]
Floats = NDArray[np.float32]

BESIDE = 1.0
"""How far the surroundings reach, in widths of the object."""
IN_FRONT_M = 0.05
FEWEST_PIXELS = 200


@dataclass(frozen=True)
class Appearance:
    """``of_object`` and ``around`` (4096,): histograms of the colours within an object's outline
    (with the fingers that usually lie over it) and around it. ``returned`` is the share of its
    surface of which a depth sensor measures the depth."""

    of_object: Floats
    around: Floats
    returned: float


def learn_appearance(
    shape: ObjectShape, samples: Iterable[tuple[Image, Array, Array]]
) -> Appearance | None:
    """From frames with the true translation (3,) and rotation (4,); None where no colour is seen.

    A few dozen frames are enough. Pixels in front of which something nearer was measured are
    left out.
    """
    of_object, around = np.zeros((2, BINS))
    returned = asked = 0
    for image, translation, rotation in samples:
        region = region_around(shape, translation, rotation, image.camera)
        if region is None:
            continue
        frame = prepare(image, region)
        depths = silhouette_depths(shape, translation, rotation, frame.camera)
        silhouette = np.isfinite(depths)
        if frame.depth is not None:
            covered = (frame.depth > 0.0) & (frame.depth < depths - IN_FRONT_M)
            seen = _interior(silhouette) & ~covered
            near = np.abs(frame.depth - np.where(seen, depths, 0.0)) < IN_FRONT_M
            returned, asked = returned + int((seen & near).sum()), asked + int(seen.sum())
            silhouette &= ~covered
        if frame.bins is not None:
            of_object += _counts(frame.bins, silhouette)
            beside = ~cv2.dilate(silhouette.astype(np.uint8), np.ones((3, 3))).astype(bool)
            around += _counts(frame.bins, beside)
    if min(of_object.sum(), around.sum()) < FEWEST_PIXELS:
        return None
    return Appearance(
        smoothed((of_object / of_object.sum()).astype(np.float32)),
        smoothed((around / around.sum()).astype(np.float32)),
        returned / asked if asked else 1.0,
    )


def region_around(
    shape: ObjectShape, translation: Array, rotation: Array, camera: Intrinsics
) -> tuple[float, float, float, float] | None:
    """The part of the image that holds an object and its surroundings; None when it holds none."""
    pixels = camera.project(rotations.rotate(rotation, shape.vertices) + translation)
    if not np.isfinite(pixels).all():
        return None
    low, high = pixels.min(axis=0), pixels.max(axis=0)
    margin = max(BESIDE * float(np.sqrt(np.prod(high - low))) / 2.0, 8.0)
    if (high < 0.0).any() or (low > [camera.width, camera.height]).any():
        return None
    left, top = (low - margin).tolist()
    right, bottom = (high + margin).tolist()
    return left, top, right, bottom


def silhouette_depths(
    shape: ObjectShape, translation: Array, rotation: Array, camera: Intrinsics
) -> Array:
    """(H, W): how far away the object's surface is in each pixel, infinite beside it."""
    placed = rotations.rotate(rotation, shape.vertices) + translation
    size = max(camera.width, camera.height)
    depths = nearest_depths(camera.project(placed), placed[:, 2], shape.faces, size)
    return depths[: camera.height, : camera.width]


def pixels_within(frame: SightFrame, depths: Array) -> NDArray[np.bool_]:
    """The pixels (H, W) of a silhouette that nothing nearer covers."""
    within = np.isfinite(depths)
    if frame.depth is not None:
        within &= ~((frame.depth > 0.0) & (frame.depth < depths - IN_FRONT_M))
    return within


def _interior(silhouette: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The silhouette without its rim, where depth is often missing; all of a thin one."""
    inner = cv2.erode(silhouette.astype(np.uint8), np.ones((3, 3))).astype(bool)
    return inner if inner.any() else silhouette


def _counts(bins: Bins, chosen: NDArray[np.bool_]) -> Array:
    return np.bincount(bins[chosen], minlength=BINS).astype(float)
