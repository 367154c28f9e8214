"""Learning the prior from labelled sequences."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtri, stdtrit

from inhand_tracker.body.anchors import ANCHORS, Anchors, find_anchors
from inhand_tracker.body.skeleton import (
    has_pelvis,
    mirror_joints,
    mirror_pose,
    part_lengths,
    standing_height,
)
from inhand_tracker.body.window import VIEWS, describe, earlier_frames, places, remember
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Indices, Singles
from inhand_tracker.mapping.learning import LabelledSequence
from inhand_tracker.prior.kernel_ridge import fit
from inhand_tracker.prior.prior import (
    TARGETS,
    Prior,
    covariance_at,
    fuse,
    locality,
    repeated,
    rotation_error,
    weights_at,
)
from inhand_tracker.shape.shape import ObjectShape

LANDMARKS = 500
GROUPS = 8
"""Participants are held out by so many groups at the most."""
CHI_SQUARE_90 = 10.645
"""Of six degrees of freedom: the 90 % region of a normal distribution."""
LONGEST_PERSISTENCE_S = 10.0


@dataclass(frozen=True)
class _Samples:
    """The usable frames (N,) of all sequences; ``groups`` are held out together."""

    descriptions: list[Singles]
    targets: Singles
    anchors: Anchors
    heights: Array
    centres: Array
    rotations: Array
    groups: Indices
    sequences: Indices
    times: Array


def learn_prior(sequences: Sequence[LabelledSequence], shape: ObjectShape) -> Prior:
    """Learn where a shape is, of people who are all mirrored to be right-handed.

    Time and memory grow with the number of frames.
    """
    centre = shape.marked_vertices.mean(axis=0)
    offsets = shape.marked_vertices - centre
    spread = offsets.T @ offsets / len(offsets)
    samples = _samples(sequences, shape, centre)
    landmarks = np.unique(
        np.linspace(0, len(samples.heights) - 1, LANDMARKS).round().astype(np.int64)
    )
    fitted = [
        fit(description, samples.targets, samples.groups, landmarks)
        for description in samples.descriptions
    ]
    regressions = tuple(regression for regression, _ in fitted)
    residuals = np.concatenate(
        [residual.reshape(len(landmarks), -1, TARGETS) for _, residual in fitted], axis=1
    )
    anchors = repeated(
        Anchors(samples.anchors.origins[landmarks], samples.anchors.axes[landmarks]), VIEWS
    )
    translation_products, rotation_products = _products(
        residuals, anchors, samples.heights[landmarks], spread
    )
    kernel = regressions[0].kernel(samples.descriptions[0][landmarks])
    groups = samples.groups[landmarks]
    kernel[groups[:, None] == groups] = 0.0
    local, nearness = locality(kernel)
    predicted = (
        np.tile(samples.targets[landmarks].reshape(len(landmarks), -1, TARGETS), (1, VIEWS, 1))
        - residuals
    )
    centres, turns = fuse(
        predicted,
        anchors,
        samples.heights[landmarks],
        weights_at(local, translation_products),
        weights_at(local, rotation_products),
        spread,
    )
    axes = samples.anchors.axes[landmarks, 0]
    moved = (centres - samples.centres[landmarks]) / samples.heights[landmarks, None]
    turned = rotation_error(turns, samples.rotations[landmarks])
    errors = np.concatenate(
        [np.einsum("lji,lj->li", axes, moved), np.einsum("lji,lj->li", axes, turned)], axis=1
    )
    return Prior(
        centre,
        spread,
        regressions,
        translation_products,
        rotation_products,
        errors,
        _calibration(covariance_at(local, nearness, errors), errors, groups),
        _persistence(errors, samples.sequences[landmarks], samples.times[landmarks]),
    )


def _samples(sequences: Sequence[LabelledSequence], shape: ObjectShape, centre: Array) -> _Samples:
    names = dict.fromkeys(sequence.participant for sequence in sequences)
    owners = {name: number for number, name in enumerate(names)}
    parts = []
    for number, sequence in enumerate(sequences):
        group = (number if len(owners) == 1 else owners[sequence.participant]) % GROUPS
        parts.append(_of_sequence(sequence, shape, centre, group, number))
    return _Samples(
        [np.concatenate([part.descriptions[v] for part in parts]) for v in range(VIEWS)],
        np.concatenate([part.targets for part in parts]),
        Anchors(
            np.concatenate([part.anchors.origins for part in parts]),
            np.concatenate([part.anchors.axes for part in parts]),
        ),
        np.concatenate([part.heights for part in parts]),
        np.concatenate([part.centres for part in parts]),
        np.concatenate([part.rotations for part in parts]),
        np.concatenate([part.groups for part in parts]),
        np.concatenate([part.sequences for part in parts]),
        np.concatenate([part.times for part in parts]),
    )


def _of_sequence(
    sequence: LabelledSequence, shape: ObjectShape, centre: Array, group: int, number: int
) -> _Samples:
    joints, translations, orientations = (
        sequence.joints,
        sequence.translations,
        sequence.rotations,
    )
    usable = np.flatnonzero(
        np.isfinite(joints).all(axis=(1, 2))
        & np.isfinite(translations).all(axis=1)
        & np.isfinite(orientations).all(axis=1)
        & (np.linalg.norm(orientations, axis=1) > 0.0)
        & np.array([has_pelvis(frame) for frame in joints])
    )
    joints, translations = joints[usable], translations[usable]
    orientations = rotations.normalise(orientations[usable])
    if sequence.left_handed:
        joints = mirror_joints(joints)
        translations, orientations = mirror_pose(translations, orientations, shape.mirror_normal)
    height = standing_height(part_lengths(joints))
    turns = rotations.to_matrix(orientations)
    centres = translations + turns @ centre
    anchors = find_anchors(joints)
    away = np.einsum("taji,taj->tai", anchors.axes, centres[:, None] - anchors.origins) / height
    within = np.swapaxes(anchors.axes, -1, -2) @ turns[:, None]
    targets = np.concatenate([away, within.reshape(len(usable), len(ANCHORS), 9)], axis=-1)
    times = usable / sequence.frame_rate
    remembered = remember(places(joints, height), times, 1.0 / sequence.frame_rate)
    earlier = joints[earlier_frames(usable, sequence.frame_rate)]
    return _Samples(
        describe(joints, earlier, remembered, height),
        targets.reshape(len(usable), -1).astype(np.float32),
        anchors,
        np.full(len(usable), height),
        centres,
        turns,
        np.full(len(usable), group),
        np.full(len(usable), number),
        times,
    )


def _products(
    residuals: Array, anchors: Anchors, heights: Array, spread: Array
) -> tuple[Singles, Singles]:
    """Inner products (L, E, E) of errors (L, E, 12): of translations in metres, and of rotations by
    how far they take the marked vertices."""
    moved = np.einsum("leij,lej->lei", anchors.axes, residuals[..., :3]) * heights[:, None, None]
    root = np.linalg.cholesky(spread + 1e-9 * np.eye(3))
    turned = anchors.axes @ residuals[..., 3:].reshape(*residuals.shape[:-1], 3, 3) @ root
    return (
        np.einsum("lei,lfi->lef", moved, moved).astype(np.float32),
        np.einsum("leij,lfij->lef", turned, turned).astype(np.float32),
    )


def _calibration(covariances: Array, errors: Array, groups: Indices) -> float:
    """By what covariances (L, 6, 6) are multiplied to hold nine in ten errors (L, 6).

    What a few people tell of the next one is less than it seems, as Student's t says: one person's
    errors go together.
    """
    solved = np.linalg.solve(covariances, errors[..., None])[..., 0]
    of_these = np.quantile(np.einsum("li,li->l", errors, solved), 0.9) / CHI_SQUARE_90
    people = len(np.unique(groups))
    return float(of_these * np.square(stdtrit(people, 0.95) / ndtri(0.95)))


def _persistence(errors: Array, sequences: Indices, times: Array) -> float:
    """How long an error (L, 6) lasts, seconds: the time constant of its correlation with itself."""
    follows = np.flatnonzero(np.diff(sequences) == 0)
    if len(follows) == 0:
        return LONGEST_PERSISTENCE_S
    unit = errors / np.sqrt(np.square(errors).mean(axis=0) + 1e-12)
    alike = np.einsum("li,li->l", unit[follows], unit[follows + 1]).mean()
    alike /= np.square(unit[follows]).sum(axis=1).mean()
    step = float(np.median(times[follows + 1] - times[follows]))
    longest = np.exp(-step / LONGEST_PERSISTENCE_S)
    return -step / float(np.log(np.clip(alike, 1e-3, longest)))
