"""What a model has learned, in a few numbers."""

from dataclasses import dataclass

import numpy as np
from inhand_tracker.body.skeleton import PARTS
from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.mapping.mapping import Mapping
from inhand_tracker.methods.darby2014.parameters import DEFAULT_DARBY2014


@dataclass(frozen=True)
class Learned:
    """``radii`` are the least, the median and the greatest δ, in body heights.

    ``good_rotations`` and ``good_translations`` are the shares of frames in which particles are
    redrawn more often than not (α, β > ½). The parts are those that the object's translation and
    rotation are predicted from most often, each with its share of frames.
    """

    recordings: int
    participants: int
    frames: int
    radii: tuple[float, float, float]
    good_rotations: float
    good_translations: float
    translation_part: tuple[str, float]
    rotation_part: tuple[str, float]


def learned_by(mapping: Mapping) -> Learned:
    """The numbers of a mapping."""
    variances = DEFAULT_DARBY2014
    least, median, greatest = np.quantile(mapping.radii, [0.0, 0.5, 1.0]).tolist()
    return Learned(
        recordings=len(mapping.participants),
        participants=len(set(mapping.participants)),
        frames=len(mapping.body_poses),
        radii=(least, median, greatest),
        good_rotations=_good(mapping.rotation_variation, variances.rotation_variance),
        good_translations=_good(mapping.translation_variation, variances.translation_variance),
        translation_part=_most_used(mapping.proximate_part),
        rotation_part=_most_used(mapping.stable_rotation_part),
    )


def _good(variation: Array, variance: float) -> float:
    return float((np.exp(-np.square(variation) / (2.0 * variance)) > 0.5).mean())


def _most_used(parts: Indices) -> tuple[str, float]:
    counts = np.bincount(parts, minlength=len(PARTS))
    most = int(np.argmax(counts))
    return PARTS[most], float(counts[most] / len(parts))
