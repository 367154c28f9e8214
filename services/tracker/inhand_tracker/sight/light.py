"""The colour of the light, by what surrounds the person, and an image in the light of training.

Nothing says what colours a room has; but they differ among each other, and light tints them all
alike (grey world: Buchsbaum 1980). Every tint that is there counts by the logarithm of how much of
it there is, so that one wide wall says little more than a cup, and by its brightness squared, as
dark colours are the least grey ones. Only what lies between red and blue is the light's, as
daylight and lamps differ; brightness, and what lies between these and green, are left alone.

Rooms differ as well. So the light counts as that of training unless it is clearly another one, and
images in the light of training stay as they are.
"""

import math

import cv2
import numpy as np

from inhand_tracker.geometry.arrays import Array, Bytes
from inhand_tracker.geometry.image import Image
from inhand_tracker.sight.kernels.count_tints import count_tints
from inhand_tracker.sight.parameters import DEFAULT_SIGHT, SightParameters

_LOGS = np.log((np.arange(4 * 255 + 1) + 2.0) / 4.0)
"""Logarithms of the mean level of four pixels, by the sum of their levels."""
_NO_DEPTH = np.zeros((0, 0), np.float32)


class LightWatch:
    """Watches the light of the images in which one object is looked for.

    ``usual`` is the ``surrounding_tint`` of training's images and how far from it any was; NaN
    where training showed none.
    """

    def __init__(
        self, usual: tuple[float, float], parameters: SightParameters = DEFAULT_SIGHT
    ) -> None:
        self._usual, self._range = usual
        self._parameters = parameters
        self._tint: float | None = None

    def watch(self, image: Image, joints: Array | None) -> None:
        """Take what an image shows around a person with joints (20, 3) in the camera frame."""
        if math.isnan(self._usual):
            return
        tint = surrounding_tint(image, joints, self._parameters)
        if tint is None:
            return
        before = tint if self._tint is None else self._tint
        self._tint = before + self._parameters.light_rate * (tint - before)

    @property
    def gains(self) -> Array | None:
        """Factors (3,) on red, green and blue that bring images into the light of training; None
        while the light may be that of training."""
        if self._tint is None:
            return None
        usual = max(self._parameters.same_light, self._range)
        change = self._tint - self._usual
        share = min((abs(change) - usual) / self._parameters.light_ramp, 1.0)
        if share <= 0.0:
            return None
        return np.exp(share * change * np.array([-1.0, 0.0, 1.0]))


def surrounding_tint(
    image: Image, joints: Array | None = None, parameters: SightParameters = DEFAULT_SIGHT
) -> float | None:
    """Estimate half the log(red / blue) of what is around a person with joints (20, 3) in the
    camera frame: of all of the picture, where no depth or joint says what is; None where too
    little is seen."""
    if image.colour is None:
        return None
    colour = image.colour
    depth, distance = _NO_DEPTH, math.nan
    if image.depth is not None and joints is not None and np.isfinite(joints[:, 2]).any():
        depth, distance = image.depth, float(np.nanmedian(joints[:, 2]))
    sums = np.zeros((parameters.tint_cells, parameters.tint_cells, 3))
    added = count_tints(
        colour,
        depth,
        (distance, parameters.person_m),
        max(2, colour.shape[1] // parameters.light_samples),
        (parameters.darkest, parameters.brightest),
        _LOGS,
        parameters.widest_tint,
        sums,
    )
    if added < parameters.fewest_surroundings:
        return None
    counts, brightness, tints = sums[sums[..., 0] > 0.0].T
    weights = np.log1p(counts / (parameters.rare_tint_share * added)) * np.square(
        brightness / counts
    )
    return float(weights @ (tints / counts) / weights.sum())


def scale_colours(colour: Bytes, gains: Array) -> Bytes:
    """Multiply red, green and blue of an image (H, W, 3) by factors (3,)."""
    levels = np.arange(256.0)[:, None] * gains
    table = np.clip(np.rint(levels), 0.0, 255.0).astype(np.uint8)
    return np.asarray(cv2.LUT(np.ascontiguousarray(colour), table[None]), np.uint8)
