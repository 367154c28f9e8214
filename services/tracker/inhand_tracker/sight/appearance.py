"""How an object looks, learned from frames in which it is known where it is."""

from collections.abc import Iterable
from dataclasses import dataclass

import cv2
import numpy as np

from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Flags, Singles
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image
from inhand_tracker.shape.raster import nearest_depths
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.sight.colours import BINS, Bins, smoothed
from inhand_tracker.sight.frame import SightFrame, prepare
from inhand_tracker.sight.limbs import limb_mask

BESIDE = 1.0
"""How far the surroundings reach, in widths of the object."""
IN_FRONT_M = 0.05
FEWEST_PIXELS = 200
MOST_COVERED = 0.8
RETURNED, BEHIND = 0.9, 0.05
"""Where no depth was seen in training."""

Sample = tuple[Image, Array, Array, Array | None]
"""A frame, the object's true translation (3,) and rotation (4,), and the joints (20, 3) of the
person, or None."""


@dataclass(frozen=True)
class Appearance:
    """``of_object`` and ``around`` (4096,): histograms of the colours within an object's outline
    (without the fingers that lie over it) and around it. ``returned`` is the share of its
    surface of which a depth sensor measures the depth, and ``behind`` the share of which it
    measures something farther away; nothing is measured of the rest."""

    of_object: Singles
    around: Singles
    returned: float
    behind: float


def learn_appearance(shape: ObjectShape, samples: Iterable[Sample]) -> Appearance | None:
    """From frames in which it is known where the object is; None where no colour is seen.

    A few dozen are enough. Pixels in front of which something nearer was measured are left out,
    and so is the share of the colours of arms and hands that fingers over the object make likely.
    """
    of_object, around, of_limbs = np.zeros((3, BINS))
    returned = behind = asked = 0
    for image, translation, rotation, joints in samples:
        region = region_around(shape, translation, rotation, image.camera)
        if region is None:
            continue
        frame = prepare(image, region)
        depths = silhouette_depths(shape, translation, rotation, frame.camera)
        silhouette = np.isfinite(depths)
        if frame.depth is not None:
            covered = (frame.depth > 0.0) & (frame.depth < depths - IN_FRONT_M)
            seen = _interior(silhouette) & ~covered
            off = frame.depth[seen] - depths[seen]
            returned += int((np.abs(off) < IN_FRONT_M).sum())
            behind += int((off >= IN_FRONT_M).sum())
            asked += len(off)
            silhouette &= ~covered
        if frame.bins is not None:
            of_object += _counts(frame.bins, silhouette)
            beside = ~cv2.dilate(silhouette.astype(np.uint8), np.ones((3, 3))).astype(bool)
            around += _counts(frame.bins, beside)
            limbs = limb_mask(joints, frame.camera, frame.depth).astype(bool)
            of_limbs += _counts(frame.bins, beside & limbs)
    if min(of_object.sum(), around.sum()) < FEWEST_PIXELS:
        return None
    return Appearance(
        smoothed(_without_limbs(of_object / of_object.sum(), of_limbs)),
        smoothed((around / around.sum()).astype(np.float32)),
        returned / asked if asked else RETURNED,
        behind / asked if asked else BEHIND,
    )


def _without_limbs(of_object: Array, of_limbs: Array) -> Singles:
    """The histogram (4096,) of an object without the fingers over it.

    How much of it they are is told by the colours that are usual for limbs: half of these, by
    weight, are no commoner on the object than the share says.
    """
    if of_limbs.sum() < FEWEST_PIXELS:
        return of_object.astype(np.float32)
    limbs = of_limbs / of_limbs.sum()
    usual = limbs > limbs.max() / 20.0
    ratios = of_object[usual] / limbs[usual]
    order = np.argsort(ratios)
    middle = np.searchsorted(np.cumsum(limbs[usual][order]), 0.5 * limbs[usual].sum())
    share = min(float(ratios[order][middle]), MOST_COVERED)
    left = np.maximum(of_object - share * limbs, 0.0)
    return np.asarray(left / left.sum(), np.float32)


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


def pixels_within(frame: SightFrame, depths: Array) -> Flags:
    """The pixels (H, W) of a silhouette that nothing nearer covers."""
    within = np.isfinite(depths)
    if frame.depth is not None:
        within &= ~((frame.depth > 0.0) & (frame.depth < depths - IN_FRONT_M))
    return within


def _interior(silhouette: Flags) -> Flags:
    """The silhouette without its rim, where depth is often missing; all of a thin one."""
    inner = cv2.erode(silhouette.astype(np.uint8), np.ones((3, 3))).astype(bool)
    return inner if inner.any() else silhouette


def _counts(bins: Bins, chosen: Flags) -> Array:
    return np.bincount(bins[chosen], minlength=BINS).astype(float)
