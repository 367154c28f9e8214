"""Follows a mapping's measures over a training sequence (Darby et al. 2014, sections 4.3, 4.4).

Angles are those of the rotations, twice the method's own θ. A gap in the labels counts as a step.
"""

from dataclasses import dataclass

import numpy as np
from inhand_tracker.body.skeleton import PARTS
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.mapping.body_pose_index import BodyPoseIndex
from inhand_tracker.mapping.mapping import Mapping

LIMBS = {
    "torso and head": ("Spine", "ShoulderCenter", "Head"),
    "other arm": ("ShoulderLeft", "ElbowLeft", "WristLeft", "HandLeft"),
    "dominant arm": ("ShoulderRight", "ElbowRight", "WristRight", "HandRight"),
    "other leg": ("HipLeft", "KneeLeft", "AnkleLeft", "FootLeft"),
    "dominant leg": ("HipRight", "KneeRight", "AnkleRight", "FootRight"),
}
"""Names of the parts of each limb, for mappings, in which everybody is right-handed."""


@dataclass(frozen=True)
class PartMeasures:
    """Measures of N frames of one sequence, lengths in body heights and angles in radians.

    ``translation_spread`` and ``rotation_spread`` (N,), roots of φᵉ and φᶿ: how much the object's
    pose varies among frames of like body pose. ``rotation_steps`` ψᶿ, ``translation_steps`` ψᵉ and
    ``distances`` ψ'ᵉ (N, 19): how far the object turns and moves relative to each part until the
    next frame, and how far it is away, on average over those frames.
    """

    translation_spread: Array
    rotation_spread: Array
    rotation_steps: Array
    translation_steps: Array
    distances: Array


def part_measures(mapping: Mapping, sequence: int) -> PartMeasures:
    """Compute the measures over one sequence of a mapping."""
    start, end = mapping.starts[sequence : sequence + 2]
    translations, orientations = mapping.translations[start:end], mapping.rotations[start:end]
    moves = np.linalg.norm(np.diff(translations, axis=0), axis=-1)
    turns = rotations.angle_between(orientations[:-1], orientations[1:])
    away = np.linalg.norm(translations, axis=-1)
    means = np.empty((3, end - start, len(PARTS)))
    index = BodyPoseIndex(mapping)
    for frame in range(end - start):
        cluster = index.cluster(int(start) + frame) - start
        steps = cluster[cluster < len(moves)]
        steps = steps if len(steps) else np.array([len(moves) - 1])
        means[:, frame] = turns[steps].mean(0), moves[steps].mean(0), away[cluster].mean(0)
    return PartMeasures(
        np.sqrt(mapping.translation_variation[start:end]),
        2.0 * np.sqrt(mapping.rotation_variation[start:end]),
        *means,
    )


def least_by_limb(by_part: Array) -> dict[str, Array]:
    """Return the least value of each limb's parts, (N, 19) → (N,), as the paper's figures do."""
    return {
        limb: by_part[:, [PARTS.index(part) for part in parts]].min(axis=1)
        for limb, parts in LIMBS.items()
    }
