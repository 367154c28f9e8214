"""Learning the prior from labelled sequences."""

from collections.abc import Sequence

import numpy as np

from inhand_tracker.body.window import VIEWS
from inhand_tracker.geometry.arrays import Array, Indices, Singles
from inhand_tracker.mapping.labelled_sequence import LabelledSequence
from inhand_tracker.prior import combination
from inhand_tracker.prior.calibration import calibration_of, widening_of
from inhand_tracker.prior.hold_learning import learn_hold
from inhand_tracker.prior.kernel_ridge import KernelRidge, fit
from inhand_tracker.prior.parameters import DEFAULT_PRIOR_LEARNING, PriorLearningParameters
from inhand_tracker.prior.prior import TARGETS, Prior
from inhand_tracker.prior.samples import Samples, samples_of, units_of
from inhand_tracker.shape.shape import ObjectShape


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
    samples = samples_of(sequences, shape, centre, parameters.groups)
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
    units = min(units_of(sequences), parameters.groups)
    return Prior(
        centre,
        spread,
        regressions,
        *products,
        errors,
        calibration_of(covariances, errors, units),
        persistence_of(
            errors, landmarks.sequences, landmarks.times, parameters.longest_persistence_s
        ),
        learn_hold(
            samples,
            landmarks,
            _in_camera(errors, landmarks),
            spread,
            units,
            parameters,
        ),
        widening_of(units),
    )


def _regressions(
    samples: Samples, rows: Indices, parameters: PriorLearningParameters
) -> tuple[tuple[KernelRidge, ...], Array]:
    """A regression for each view, on landmarks in rows (L,), and all held-out residuals
    (L, E, 12)."""
    fitted = [
        fit(description, samples.targets, samples.groups, rows, parameters)
        for description in samples.descriptions
    ]
    residuals = [residual.reshape(len(rows), -1, TARGETS) for _, residual in fitted]
    return tuple(regression for regression, _ in fitted), np.concatenate(residuals, axis=1)


def _products(residuals: Array, landmarks: Samples, spread: Array) -> tuple[Singles, Singles]:
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
    landmarks: Samples,
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


def _in_camera(errors: Array, landmarks: Samples) -> Array:
    """Give errors (L, 6) in the trunk's axes and body heights in the camera frame and metres."""
    axes = landmarks.anchors.axes[:, 0]
    moved = errors[:, :3] * landmarks.heights[:, None]
    return np.concatenate(
        [np.einsum("lij,lj->li", axes, one) for one in (moved, errors[:, 3:])], axis=1
    )


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
