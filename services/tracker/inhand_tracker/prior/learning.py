"""Learning the prior from labelled sequences."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtri, stdtrit

from inhand_tracker.body.anchors import ANCHORS, Anchors, find_anchors
from inhand_tracker.body.skeleton import has_pelvis, stature_of
from inhand_tracker.body.window import (
    VIEWS,
    describe_bodies,
    earlier_frames,
    remember_places,
    trunk_places,
)
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Indices, Singles
from inhand_tracker.mapping.learning import LabelledSequence
from inhand_tracker.prior import combination
from inhand_tracker.prior.kernel_ridge import KernelRidge, fit
from inhand_tracker.prior.parameters import DEFAULT_PRIOR_LEARNING, PriorLearningParameters
from inhand_tracker.prior.prior import TARGETS, Prior
from inhand_tracker.shape.shape import ObjectShape

CHI_SQUARE_90 = 10.645
"""Square of the radius of a normal distribution's 90 % region in six dimensions."""


def learn_prior(
    sequences: Sequence[LabelledSequence],
    shape: ObjectShape,
    parameters: PriorLearningParameters = DEFAULT_PRIOR_LEARNING,
) -> Prior:
    """Learn where an object of a shape is, of people who are all mirrored to be right-handed.

    Time and memory grow with the number of frames.
    """
    centre = shape.marked_vertices.mean(axis=0)
    offsets = shape.marked_vertices - centre
    spread = offsets.T @ offsets / len(offsets)
    samples = _samples(sequences, shape, centre, parameters.groups)
    spaced = np.linspace(0, len(samples.heights) - 1, parameters.landmarks)
    rows = np.unique(spaced.round().astype(np.int64))
    regressions, residuals = _regressions(samples, rows, parameters)
    landmarks = samples.take(rows)
    products = _products(residuals, landmarks, spread)
    kernel = regressions[0].kernel(landmarks.descriptions[0])
    kernel[landmarks.groups[:, None] == landmarks.groups] = 0.0
    local, nearness = combination.locality(kernel)
    errors = _errors(landmarks, residuals, local, products, spread)
    covariances = combination.covariance_at(local, nearness, errors)
    return Prior(
        centre,
        spread,
        regressions,
        *products,
        errors,
        calibration_of(covariances, errors, landmarks.groups),
        persistence_of(
            errors, landmarks.sequences, landmarks.times, parameters.longest_persistence_s
        ),
    )


@dataclass(frozen=True)
class _Samples:
    """The usable frames (N,) of all sequences; those of one of ``groups`` are held out together."""

    descriptions: list[Singles]
    targets: Singles
    anchors: Anchors
    heights: Array
    centres: Array
    rotations: Array
    groups: Indices
    sequences: Indices
    times: Array

    @staticmethod
    def joined(parts: "Sequence[_Samples]") -> "_Samples":
        """The samples of parts, one after the other."""
        return _Samples(
            descriptions=[
                np.concatenate([part.descriptions[view] for part in parts]) for view in range(VIEWS)
            ],
            anchors=Anchors(
                np.concatenate([part.anchors.origins for part in parts]),
                np.concatenate([part.anchors.axes for part in parts]),
            ),
            **{name: np.concatenate([getattr(part, name) for part in parts]) for name in _ROWS},
        )

    def take(self, rows: Indices) -> "_Samples":
        """The samples with these indices, in this order."""
        return _Samples(
            descriptions=[description[rows] for description in self.descriptions],
            anchors=Anchors(self.anchors.origins[rows], self.anchors.axes[rows]),
            **{name: getattr(self, name)[rows] for name in _ROWS},
        )


_ROWS = ("targets", "heights", "centres", "rotations", "groups", "sequences", "times")
"""Names of the samples' plain arrays."""


def _samples(
    sequences: Sequence[LabelledSequence], shape: ObjectShape, centre: Array, groups: int
) -> _Samples:
    names = dict.fromkeys(sequence.participant for sequence in sequences)
    owners = {name: number for number, name in enumerate(names)}
    parts = []
    for number, sequence in enumerate(sequences):
        group = (number if len(owners) == 1 else owners[sequence.participant]) % groups
        parts.append(_samples_of(sequence, shape, centre, group, number))
    return _Samples.joined(parts)


def _samples_of(
    sequence: LabelledSequence, shape: ObjectShape, centre: Array, group: int, number: int
) -> _Samples:
    """The usable frames of the sequence of a number, which is held out with a group."""
    usable = _usable_frames(sequence)
    right_handed = sequence.right_handed(shape.mirror_normal)
    joints = right_handed.joints[usable]
    height = stature_of(joints)
    turns = rotations.to_matrix(right_handed.rotations[usable])
    centres = right_handed.translations[usable] + turns @ centre
    anchors = find_anchors(joints)
    times = usable / sequence.frame_rate
    remembered = remember_places(trunk_places(joints, height), times, 1.0 / sequence.frame_rate)
    earlier = joints[earlier_frames(usable, sequence.frame_rate)]
    return _Samples(
        describe_bodies(joints, earlier, remembered, height),
        _targets(anchors, centres, turns, height),
        anchors,
        np.full(len(usable), height),
        centres,
        turns,
        np.full(len(usable), group),
        np.full(len(usable), number),
        times,
    )


def _usable_frames(sequence: LabelledSequence) -> Indices:
    """The frames in which the whole body and the object's label are known."""
    return np.flatnonzero(
        np.isfinite(sequence.joints).all(axis=(1, 2))
        & np.isfinite(sequence.translations).all(axis=1)
        & np.isfinite(sequence.rotations).all(axis=1)
        & (np.linalg.norm(sequence.rotations, axis=1) > 0.0)
        & np.array([has_pelvis(frame) for frame in sequence.joints])
    )


def _targets(anchors: Anchors, centres: Array, turns: Array, height: float) -> Singles:
    """What regressions shall predict, (N, A * 12): the object in each anchor."""
    away = np.einsum("taji,taj->tai", anchors.axes, centres[:, None] - anchors.origins) / height
    within = np.swapaxes(anchors.axes, -1, -2) @ turns[:, None]
    targets = np.concatenate([away, within.reshape(len(turns), len(ANCHORS), 9)], axis=-1)
    return targets.reshape(len(turns), -1).astype(np.float32)


def _regressions(
    samples: _Samples, rows: Indices, parameters: PriorLearningParameters
) -> tuple[tuple[KernelRidge, ...], Array]:
    """A regression for each view, on landmarks in rows (L,), and all held-out residuals
    (L, E, 12)."""
    fitted = [
        fit(description, samples.targets, samples.groups, rows, parameters)
        for description in samples.descriptions
    ]
    residuals = [residual.reshape(len(rows), -1, TARGETS) for _, residual in fitted]
    return tuple(regression for regression, _ in fitted), np.concatenate(residuals, axis=1)


def _products(residuals: Array, landmarks: _Samples, spread: Array) -> tuple[Singles, Singles]:
    """Inner products (L, E, E) of errors (L, E, 12): of translations in metres, and of rotations by
    how far they take the marked vertices."""
    axes = np.tile(landmarks.anchors.axes, (1, VIEWS, 1, 1))
    moved = np.einsum("leij,lej->lei", axes, residuals[..., :3]) * landmarks.heights[:, None, None]
    root = np.linalg.cholesky(spread + 1e-9 * np.eye(3))
    turned = axes @ residuals[..., 3:].reshape(*residuals.shape[:-1], 3, 3) @ root
    return (
        np.einsum("lei,lfi->lef", moved, moved).astype(np.float32),
        np.einsum("leij,lfij->lef", turned, turned).astype(np.float32),
    )


def _errors(
    landmarks: _Samples,
    residuals: Array,
    local: Array,
    products: tuple[Singles, Singles],
    spread: Array,
) -> Array:
    """Held-out errors (L, 6) of the fused estimate, in the trunk's axes and body heights."""
    targets = landmarks.targets.reshape(len(local), -1, TARGETS)
    translation_products, rotation_products = (
        combination.products_at(local, one) for one in products
    )
    weights = (
        combination.combination_weights(translation_products),
        combination.combination_weights(rotation_products),
    )
    predicted = np.tile(targets, (1, VIEWS, 1)) - residuals
    centres, turns = combination.fuse(
        predicted, landmarks.anchors, landmarks.heights, weights, spread
    )
    axes = landmarks.anchors.axes[:, 0]
    moved = (centres - landmarks.centres) / landmarks.heights[:, None]
    turned = combination.rotation_error(turns, landmarks.rotations)
    return np.concatenate(
        [np.einsum("lji,lj->li", axes, moved), np.einsum("lji,lj->li", axes, turned)], axis=1
    )


def calibration_of(covariances: Array, errors: Array, groups: Indices) -> float:
    """The factor on covariances (L, 6, 6) by which they hold nine in ten errors (L, 6).

    A few people say less of the next one than it seems, as Student's t has it: one person's errors
    go together.
    """
    solved = np.linalg.solve(covariances, errors[..., None])[..., 0]
    of_these = np.quantile(np.einsum("li,li->l", errors, solved), 0.9) / CHI_SQUARE_90
    people = len(np.unique(groups))
    return float(of_these * np.square(stdtrit(people, 0.95) / ndtri(0.95)))


def persistence_of(errors: Array, sequences: Indices, times: Array, longest_s: float) -> float:
    """Seconds that an error (L, 6) lasts: the time constant of its correlation with itself."""
    follows = np.flatnonzero(np.diff(sequences) == 0)
    if len(follows) == 0:
        return longest_s
    unit = errors / np.sqrt(np.square(errors).mean(axis=0) + 1e-12)
    alike = np.einsum("li,li->l", unit[follows], unit[follows + 1]).mean()
    alike /= np.square(unit[follows]).sum(axis=1).mean()
    step = float(np.median(times[follows + 1] - times[follows]))
    longest = np.exp(-step / longest_s)
    return -step / float(np.log(np.clip(alike, 1e-3, longest)))
