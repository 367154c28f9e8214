"""Particles: indices into the training frames, and how they move and are redrawn.

Darby et al. 2014, sections 5.3 to 5.5. All particles of a set are arrays of length P.
"""

from dataclasses import dataclass, replace

import numpy as np

from inhand_tracker.body.skeleton import PARTS, RIGHT_HAND, Bases
from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.mapping.body_pose_index import BodyPoseIndex
from inhand_tracker.mapping.mapping import Mapping
from inhand_tracker.methods.darby2014.parameters import DEFAULT_DARBY2014, Darby2014Parameters
from inhand_tracker.methods.darby2014.variants import PartRule, Variant


@dataclass(frozen=True)
class Particles:
    """(n_T, n_R, l_T, l_R) of P particles; the training participants follow from the frames."""

    translation_frames: Indices
    rotation_frames: Indices
    translation_parts: Indices
    rotation_parts: Indices

    def take(self, chosen: Indices) -> "Particles":
        """The particles with these indices, in this order."""
        return Particles(
            self.translation_frames[chosen],
            self.rotation_frames[chosen],
            self.translation_parts[chosen],
            self.rotation_parts[chosen],
        )

    def poses(self, mapping: Mapping, bases: Bases, height: float) -> tuple[Array, Array]:
        """Object poses in the camera frame, (P, 3) and (P, 4) (equations 14 and 15)."""
        translations, _ = _of_parts(bases, self.translation_parts).to_camera(
            mapping.translations[self.translation_frames, self.translation_parts] * height,
            np.array([1.0, 0.0, 0.0, 0.0]),
        )
        _, orientations = _of_parts(bases, self.rotation_parts).to_camera(
            np.zeros(3), mapping.rotations[self.rotation_frames, self.rotation_parts]
        )
        return translations, orientations


def propagate(
    particles: Particles,
    mapping: Mapping,
    random: np.random.Generator,
    parameters: Darby2014Parameters = DEFAULT_DARBY2014,
) -> Particles:
    """The generative step: both indices move through their sequences (equations 10 and 11)."""
    return replace(
        particles,
        translation_frames=_walk(particles.translation_frames, mapping, random, parameters),
        rotation_frames=_walk(particles.rotation_frames, mapping, random, parameters),
    )


def mixing_fractions(
    mapping: Mapping, frame: int, parameters: Darby2014Parameters = DEFAULT_DARBY2014
) -> tuple[float, float]:
    """α and β: the probabilities that rotation and translation are redrawn (equations 12, 13)."""
    rotation = mapping.rotation_variation[frame] ** 2 / (2.0 * parameters.rotation_variance)
    translation = mapping.translation_variation[frame] ** 2 / (
        2.0 * parameters.translation_variance
    )
    return float(np.exp(-rotation)), float(np.exp(-translation))


def redraw(
    particles: Particles,
    fresh: Particles,
    fractions: tuple[float, float],
    random: np.random.Generator,
) -> Particles:
    """The discriminative step: of as many fresh particles, rotations are taken with probability α
    (D2), and translations independently with β (D3, section 5.4)."""
    alpha, beta = fractions
    count = len(particles.translation_frames)
    turn, move = random.random((2, count)) < np.array([[alpha], [beta]])
    return Particles(
        np.where(move, fresh.translation_frames, particles.translation_frames),
        np.where(turn, fresh.rotation_frames, particles.rotation_frames),
        np.where(move, fresh.translation_parts, particles.translation_parts),
        np.where(turn, fresh.rotation_parts, particles.rotation_parts),
    )


def draw(
    count: int,
    mapping: Mapping,
    index: BodyPoseIndex,
    nearest: int,
    method: Variant,
    random: np.random.Generator,
) -> Particles:
    """Particles from the cluster of a training frame: D2 and D3 for all (section 5.4)."""
    cluster = index.cluster(nearest)
    translation_frames, rotation_frames = random.choice(cluster, (2, count))
    at_nearest = np.full(count, nearest)
    translation_parts = translation_parts_at(at_nearest, mapping, method, random)
    rotation_parts = rotation_parts_at(at_nearest, mapping, method, random)
    return Particles(translation_frames, rotation_frames, translation_parts, rotation_parts)


def _walk(
    frames: Indices,
    mapping: Mapping,
    random: np.random.Generator,
    parameters: Darby2014Parameters,
) -> Indices:
    sequences = mapping.sequence_of(frames)
    first, end = mapping.starts[sequences], mapping.starts[sequences + 1]
    advanced = frames - first + parameters.advance
    local = np.abs(random.normal(advanced, parameters.index_sigma))
    return first + np.minimum(np.rint(local).astype(np.int64), end - first - 1)


def translation_parts_at(
    frames: Indices, mapping: Mapping, method: Variant, random: np.random.Generator
) -> Indices:
    """l_T of each of P training frames, by the method."""
    best = (
        mapping.stable_translation_part
        if method.translation_part == "stable"
        else mapping.proximate_part
    )
    return _parts(method.translation_part, best, frames, random)


def rotation_parts_at(
    frames: Indices, mapping: Mapping, method: Variant, random: np.random.Generator
) -> Indices:
    """l_R of each of P training frames, by the method."""
    return _parts(method.rotation_part, mapping.stable_rotation_part, frames, random)


def _parts(rule: PartRule, best: Indices, frames: Indices, random: np.random.Generator) -> Indices:
    if rule == "random":
        return random.integers(len(PARTS), size=len(frames))
    if rule == "hand":
        return np.full(len(frames), RIGHT_HAND)
    return best[frames]


def _of_parts(bases: Bases, parts: Indices) -> Bases:
    return Bases(bases.origins[parts], bases.rotations[parts])
