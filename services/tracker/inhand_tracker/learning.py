"""Learning from labelled sequences (Darby et al. 2014, TR1 to TR3).

For every training frame: how much the object's pose varies among frames of like body pose (a low
variation is a good moment to re-initialise), and how stable and how close the object is relative
to each of the 19 parts.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import cdist

from inhand_tracker import rotations
from inhand_tracker.body import (
    body_pose,
    mirror_joints,
    mirror_pose,
    part_bases,
    part_lengths,
    pelvis_basis,
    standing_height,
)
from inhand_tracker.mapping import Mapping

Array = NDArray[np.float64]

NEIGHBOUR_CHUNK = 2048


@dataclass(frozen=True)
class LabelledSequence:
    """One recording of one person with the object's pose in every frame, in the camera frame.

    ``joints`` (N, 20, 3), ``translations`` (N, 3), ``rotations`` (N, 4). Frames that are not
    usable (a missing joint or label) hold NaN and are left out, with the step into them.
    """

    participant: str
    left_handed: bool
    joints: Array
    translations: Array
    rotations: Array


class UnusableSequenceError(ValueError):
    """A sequence, or a set of them, that nothing can be learned from."""


def learn(sequences: Sequence[LabelledSequence], mirror_normal: Array) -> Mapping:
    """Learn a mapping; left-handed people are mirrored, so that every mapping is right-handed.

    ``mirror_normal`` (3,) is the object's (``ObjectShape``). Raises UnusableSequenceError.
    """
    if len(sequences) < 2:
        raise UnusableSequenceError(
            f"learning compares sequences, and there is {len(sequences)}: two are the least"
        )
    parts = [_relative_poses(sequence, mirror_normal) for sequence in sequences]
    participants = [sequence.participant for sequence in sequences]
    radii = [
        _cluster_radius(index, [part.body_poses for part in parts], participants)
        for index in range(len(parts))
    ]
    measures = [_measure(part, radius) for part, radius in zip(parts, radii, strict=True)]
    lengths = [len(part.body_poses) for part in parts]
    return Mapping(
        participants=tuple(participants),
        starts=np.concatenate(([0], np.cumsum(lengths))),
        radii=np.array(radii),
        body_poses=np.concatenate([part.body_poses for part in parts]),
        translations=np.concatenate([part.translations for part in parts]),
        rotations=np.concatenate([part.rotations for part in parts]),
        translation_variation=np.concatenate([m.translation_variation for m in measures]),
        rotation_variation=np.concatenate([m.rotation_variation for m in measures]),
        stable_translation_part=np.concatenate([m.stable_translation_part for m in measures]),
        stable_rotation_part=np.concatenate([m.stable_rotation_part for m in measures]),
        proximate_part=np.concatenate([m.proximate_part for m in measures]),
    )


@dataclass(frozen=True)
class _RelativePoses:
    """TR1: ``body_poses`` (N, 60), the object relative to each part (N, 19, 3) and (N, 19, 4).

    ``consecutive`` (N,) tells whether the next row is the next frame.
    """

    body_poses: Array
    translations: Array
    rotations: Array
    consecutive: NDArray[np.bool_]


@dataclass(frozen=True)
class _Measures:
    """TR2 and TR3 of one sequence, each (N,)."""

    translation_variation: Array
    rotation_variation: Array
    stable_translation_part: NDArray[np.int64]
    stable_rotation_part: NDArray[np.int64]
    proximate_part: NDArray[np.int64]


def _relative_poses(sequence: LabelledSequence, mirror_normal: Array) -> _RelativePoses:
    joints, translations = sequence.joints, sequence.translations
    with np.errstate(invalid="ignore", divide="ignore"):
        orientations = rotations.normalise(sequence.rotations)
    if sequence.left_handed:
        joints = mirror_joints(joints)
        translations, orientations = mirror_pose(translations, orientations, mirror_normal)
    height = standing_height(part_lengths(joints))
    with np.errstate(invalid="ignore", divide="ignore"):
        pelvis = pelvis_basis(joints)
    poses = body_pose(joints, pelvis, height)
    usable = np.flatnonzero(
        np.isfinite(poses).all(axis=1)
        & np.isfinite(pelvis.rotations).all(axis=1)
        & np.isfinite(translations).all(axis=1)
        & np.isfinite(orientations).all(axis=1)
    )
    if len(usable) < 2:
        raise UnusableSequenceError(
            f"a sequence of participant {sequence.participant!r} has {len(usable)} frames in "
            "which the whole body and the object's label are known: two are the least"
        )
    pelvis = pelvis_basis(joints[usable])
    bases = part_bases(joints[usable], pelvis)
    relative_translations, relative_rotations = bases.from_camera(
        translations[usable, None, :], orientations[usable, None, :]
    )
    return _RelativePoses(
        poses[usable],
        relative_translations / height,
        relative_rotations,
        np.append(np.diff(usable) == 1, False),
    )


def _cluster_radius(index: int, body_poses: list[Array], participants: list[str]) -> float:
    """δ: the median distance to the nearest body pose of other participants (or recordings)."""
    others = [
        poses
        for poses, participant in zip(body_poses, participants, strict=True)
        if participant != participants[index]
    ] or [poses for other, poses in enumerate(body_poses) if other != index]
    nearest = np.full(len(body_poses[index]), np.inf)
    for poses in others:
        for start in range(0, len(poses), NEIGHBOUR_CHUNK):
            distances = cdist(body_poses[index], poses[start : start + NEIGHBOUR_CHUNK])
            np.minimum(nearest, distances.min(axis=1), out=nearest)
    return float(np.median(nearest))


def _measure(part: _RelativePoses, radius: float) -> _Measures:
    frames = len(part.body_poses)
    steps_translation = np.linalg.norm(np.diff(part.translations, axis=0), axis=-1)
    steps_rotation = rotations.separation(part.rotations[:-1], part.rotations[1:])
    has_step = part.consecutive[:-1]
    distances = np.linalg.norm(part.translations, axis=-1)
    variation = np.empty((2, frames))
    best_parts = np.empty((3, frames), np.int64)
    for frame in range(frames):
        cluster = np.flatnonzero(
            cdist(part.body_poses[frame : frame + 1], part.body_poses)[0] <= radius
        )
        cluster = cluster if len(cluster) else np.array([frame])
        variation[:, frame] = _variation(part.translations[cluster], part.rotations[cluster])
        steps = cluster[cluster < frames - 1]
        steps = steps[has_step[steps]]
        if len(steps) == 0:
            steps = np.array([min(frame, frames - 2)])
        best_parts[:, frame] = (
            np.argmin(steps_translation[steps].mean(axis=0)),
            np.argmin(steps_rotation[steps].mean(axis=0)),
            np.argmin(distances[cluster].mean(axis=0)),
        )
    return _Measures(*variation, *best_parts)


def _variation(translations: Array, orientations: Array) -> tuple[float, float]:
    """φᵉ and φᶿ of a cluster: medians over the parts of the mean squared deviation."""
    offsets = translations - translations.mean(axis=0)
    by_part = np.swapaxes(orientations, 0, 1)
    centres = rotations.mean(by_part, np.ones(by_part.shape[:-1]))
    turns = rotations.separation(by_part, centres[:, None, :])
    return (
        float(np.median(np.square(offsets).sum(axis=-1).mean(axis=0))),
        float(np.median(np.square(turns).mean(axis=1))),
    )
