"""How an object looks, learned from frames with its true pose."""

import math
from collections.abc import Iterable
from dataclasses import dataclass, field

import cv2
import numpy as np

from inhand_tracker.geometry.arrays import Array, Flags, Singles
from inhand_tracker.geometry.image import Image
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.sight.colours import BINS, Bins, smoothed
from inhand_tracker.sight.frame import SightFrame, prepare
from inhand_tracker.sight.light import surrounding_tint
from inhand_tracker.sight.limbs import limb_mask
from inhand_tracker.sight.parameters import DEFAULT_SIGHT, SightParameters
from inhand_tracker.sight.silhouette import (
    interior,
    object_shares,
    pixels_covered,
    region_around,
    silhouette_depths,
    weights_of_sides,
)

AppearanceSample = tuple[Image, Array, Array, Array | None]
"""A frame, the object's true translation (3,) and rotation (4,), and the joints (20, 3) of the
person, or None."""


@dataclass(frozen=True)
class Appearance:
    """``of_object`` and ``around`` (4096,): histograms of the colours within an object's outline
    (without the fingers that lie over it) and around it. ``returned`` is the share of its
    surface of which a depth sensor measures the depth, and ``behind`` the share of which it
    measures something farther away; nothing is measured of the rest. ``tint`` is the mean
    ``surrounding_tint`` of the images, and ``tint_range`` how far from it any of them was; NaN
    where none showed it, and in models of older releases."""

    of_object: Singles
    around: Singles
    returned: float
    behind: float
    tint: float = math.nan
    tint_range: float = math.nan


@dataclass
class _Counts:
    """Pixels of all samples: by colour (4096,), on the object, around it, and of limbs around it;
    and how many of the object's returned depth, or that of something behind."""

    of_object: Array = field(default_factory=lambda: np.zeros(BINS))
    around: Array = field(default_factory=lambda: np.zeros(BINS))
    of_limbs: Array = field(default_factory=lambda: np.zeros(BINS))
    returned: int = 0
    behind: int = 0
    looked_at: int = 0

    def add_depths(self, frame: SightFrame, depths: Array, silhouette: Flags) -> None:
        """Count what was measured of the surface where nothing covers it."""
        if frame.depth is None:
            return
        uncovered = interior(silhouette) & ~pixels_covered(
            frame.depth, depths, frame.parameters.aside_m
        )
        off = frame.depth[uncovered] - depths[uncovered]
        self.returned += int((np.abs(off) < frame.parameters.aside_m).sum())
        self.behind += int((off >= frame.parameters.aside_m).sum())
        self.looked_at += len(off)

    def add_colours(
        self, frame: SightFrame, shares: Singles, hidden: Flags, joints: Array | None
    ) -> None:
        """Count colours by the object's ``shares`` in pixels (H, W) that are not ``hidden``, and
        beside it those of a person with joints (20, 3)."""
        if frame.bins is None:
            return
        beside = ~cv2.dilate((shares > 0.0).astype(np.uint8), np.ones((3, 3))).astype(bool)
        of_object, around = weights_of_sides(shares, hidden, beside)
        self.of_object += _counts(frame.bins, of_object)
        self.around += _counts(frame.bins, around)
        limbs = limb_mask(joints, frame.camera, frame.depth, frame.parameters).astype(bool)
        self.of_limbs += _counts(frame.bins, (beside & limbs).astype(np.float32))


def learn_appearance(
    shape: ObjectShape,
    samples: Iterable[AppearanceSample],
    parameters: SightParameters = DEFAULT_SIGHT,
) -> Appearance | None:
    """Learn from frames with the object's true pose; None where no colour is seen.

    A few dozen are enough. Pixels in front of which something nearer was measured are left out,
    and so is the share of the colours of arms and hands that fingers over the object make likely.
    """
    counts = _Counts()
    tints: list[float] = []
    for image, translation, rotation, joints in samples:
        region = region_around(shape, translation, rotation, image.camera, parameters)
        if region is None:
            continue
        tint = surrounding_tint(image, joints, parameters)
        tints += [] if tint is None else [tint]
        frame = prepare(image, region, parameters)
        depths = silhouette_depths(shape, translation, rotation, frame.camera)
        silhouette = np.isfinite(depths)
        counts.add_depths(frame, depths, silhouette)
        hidden = pixels_covered(frame.depth, depths, frame.parameters.aside_m)
        shares = object_shares(shape, translation, rotation, frame.camera)
        counts.add_colours(frame, shares, hidden, joints)
    of_object, around = counts.of_object, counts.around
    if min(of_object.sum(), around.sum()) < parameters.fewest_pixels:
        return None
    own = _without_limbs(of_object / of_object.sum(), counts.of_limbs, parameters)
    looked_at = counts.looked_at
    return Appearance(
        smoothed(own, parameters),
        smoothed((around / around.sum()).astype(np.float32), parameters),
        counts.returned / looked_at if looked_at else parameters.returned,
        counts.behind / looked_at if looked_at else parameters.behind,
        *_mean_and_range(tints),
    )


def _mean_and_range(tints: list[float]) -> tuple[float, float]:
    if not tints:
        return math.nan, math.nan
    mean = float(np.mean(tints))
    return mean, float(np.abs(np.array(tints) - mean).max())


def _without_limbs(of_object: Array, of_limbs: Array, parameters: SightParameters) -> Singles:
    """Take the fingers over an object out of its histogram (4096,).

    The colours that are usual for limbs show which share of it they are: half of these, by
    weight, are no commoner on the object than that share says.
    """
    if of_limbs.sum() < parameters.fewest_pixels:
        return of_object.astype(np.float32)
    limbs = of_limbs / of_limbs.sum()
    usual = limbs > limbs.max() / parameters.usual_limb_ratio
    ratios = of_object[usual] / limbs[usual]
    order = np.argsort(ratios)
    middle = np.searchsorted(np.cumsum(limbs[usual][order]), 0.5 * limbs[usual].sum())
    share = min(float(ratios[order][middle]), parameters.most_covered)
    left = np.maximum(of_object - share * limbs, 0.0)
    return np.asarray(left / left.sum(), np.float32)


def _counts(bins: Bins, weights: Singles) -> Array:
    return np.bincount(bins.ravel(), weights.ravel(), minlength=BINS).astype(float)
