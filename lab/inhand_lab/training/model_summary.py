"""Sums up in a few numbers what a model has learned."""

from dataclasses import dataclass

import numpy as np
from inhand_tracker.body.skeleton import PARTS
from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.mapping.mapping import Mapping
from inhand_tracker.methods.darby2014.parameters import DEFAULT_DARBY2014


@dataclass(frozen=True)
class ModelSummary:
    """What a model was learned from, and how well poses can be predicted with it.

    ``radii`` are the least, the median and the greatest δ, in statures. ``good_rotations`` and
    ``good_translations`` are the shares of frames in which particles are redrawn more often than
    not (α, β > ½). The parts are those that the object's translation and rotation are predicted
    from most often, each with its share of frames.
    """

    recordings: int
    participants: int
    frames: int
    radii: tuple[float, float, float]
    good_rotations: float
    good_translations: float
    translation_part: tuple[str, float]
    rotation_part: tuple[str, float]


def summarise_model(mapping: Mapping) -> ModelSummary:
    """Sum up a model by its mapping."""
    variances = DEFAULT_DARBY2014
    least, median, greatest = np.quantile(mapping.radii, [0.0, 0.5, 1.0]).tolist()
    return ModelSummary(
        recordings=len(mapping.participants),
        participants=len(set(mapping.participants)),
        frames=len(mapping.body_poses),
        radii=(least, median, greatest),
        good_rotations=_redrawn_share(mapping.rotation_variation, variances.rotation_variance),
        good_translations=_redrawn_share(
            mapping.translation_variation, variances.translation_variance
        ),
        translation_part=_most_used(mapping.proximate_part),
        rotation_part=_most_used(mapping.stable_rotation_part),
    )


def _redrawn_share(variation: Array, variance: float) -> float:
    """Share of frames in which a particle is redrawn with a probability above one half."""
    return float((np.exp(-np.square(variation) / (2.0 * variance)) > 0.5).mean())


def _most_used(parts: Indices) -> tuple[str, float]:
    """Return the part that is used in most frames, and its share of them."""
    counts = np.bincount(parts, minlength=len(PARTS))
    most = int(np.argmax(counts))
    return PARTS[most], float(counts[most] / len(parts))
