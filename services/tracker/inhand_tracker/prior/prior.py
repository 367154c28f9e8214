"""Where an object is, from the body alone: many predictions, fused by how well each does here.

A kernel regression predicts the object in each anchor of the body (``anchors``), from each view of
the body's last moments (``body_window``). Where predictions were wrong, and how their errors went
together, is known from people who were held out in training. So those of like body poses give the
weights of the best linear unbiased combination, and the covariance of what comes out.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from inhand_tracker.body.anchors import ANCHORS, Anchors
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Singles
from inhand_tracker.prior.kernel_ridge import KernelRidge

TARGETS = 12
"""Of each anchor: the object's centre, in body heights, then its rotation matrix, row by row."""
DISTRUST = 0.1
"""Of each prediction's own variance, added to it: no weight lives on small differences."""
TINY = 1e-300
FAR = 0.4
"""A kernel below this at all landmarks, as it is for one in a hundred poses of people who were not
learned from, is stretched to it: far from what was learned the nearest of it is the best guess."""
MOST_STRETCHED = 3.0
"""So many times is the guess's deviation stretched as well, at the most."""
NEW = 0.7
"""A body is new where the kernel is below this at all landmarks, the more so the smaller it is:
what carries the object along then tells more than where it was usual."""
BASE = 0.1
"""Share of the covariance over all body poses in that of any."""


@dataclass(frozen=True)
class Prior:
    """What was learned of one object's poses, as of right-handed people; L landmarks.

    ``centre`` (3,) and ``spread`` (3, 3) are mean and covariance of the marked vertices.
    ``regressions`` (V of them) predict (A * 12). ``translation_products`` and
    ``rotation_products`` (L, V A, V A) are the inner products of the predictions' held-out errors
    at each landmark; ``errors`` (L, 6) those of the fused estimate, translation of the centre in
    body heights and rotation vector on the left, in the trunk's axes. ``calibration`` scales the
    covariance so that nine in ten held-out errors lie within its 90 % region. ``persistence_s``
    is how long an error lasts.
    """

    centre: Array
    spread: Array
    regressions: tuple[KernelRidge, ...]
    translation_products: Singles
    rotation_products: Singles
    errors: Array
    calibration: float
    persistence_s: float

    @cached_property
    def landmark_targets(self) -> Array:
        """(L, V A, 12): the object in each anchor at each landmark, as each regression has it."""
        fitted = [one.predict(one.landmarks) for one in self.regressions]
        return np.concatenate([one.reshape(len(one), -1, TARGETS) for one in fitted], axis=1)


@dataclass(frozen=True)
class Prediction:
    """The expected pose of the object's centre, in the camera frame of right-handed people.

    ``centre`` (3,), ``rotation`` (3, 3), and ``covariance`` (6, 6) of (translation of the centre,
    rotation vector on the left).
    """

    centre: Array
    rotation: Array
    covariance: Array


def predict(
    prior: Prior, descriptions: list[Singles], anchors: Anchors, height: float
) -> Prediction:
    """The object's pose for one body: descriptions (1, D) of each view, its anchors and height."""
    kernels = [
        regression.kernel(description)
        for regression, description in zip(prior.regressions, descriptions, strict=True)
    ]
    stretches = [max(FAR / max(float(kernel.max()), TINY), 1.0) for kernel in kernels]
    predicted = np.concatenate(
        [
            (stretch * kernel @ regression.coefficients + regression.offset).reshape(-1, TARGETS)
            for stretch, kernel, regression in zip(
                stretches, kernels, prior.regressions, strict=True
            )
        ]
    )
    local, nearness = locality(kernels[0])
    moved, turned = at(local, prior.translation_products), at(local, prior.rotation_products)
    around = repeated(anchors, len(prior.regressions))
    turn_weights = weights_of(turned)
    centre, rotation = fuse(
        predicted[None], around, height, weights_of(moved), turn_weights, prior.spread
    )
    doubt = float(np.clip(stretches[0], 1.0, MOST_STRETCHED)) ** 2
    covariance = doubt * prior.calibration * covariance_at(local, nearness, prior.errors)[0]
    turn = np.kron(np.eye(2), anchors.axes[0])
    scale = np.repeat([height, 1.0], 3)
    covariance = turn @ (covariance * scale[:, None] * scale) @ turn.T
    novelty = 1.0 - float(kernels[0].max()) / NEW
    if novelty <= 0.0:
        return Prediction(centre[0], rotation[0], covariance)
    nearest, shares = _taken_along(prior, local)
    predicted = predicted + novelty * (nearest - predicted)
    worse = 1.0 + novelty * (shares - 1.0)
    move_weights = weights_of(worse[:, None] * moved * worse)
    along, turned_along = fuse(
        predicted[None], around, height, move_weights, turn_weights, prior.spread
    )
    apart = np.square([along[0] - centre[0], rotation_error(turned_along, rotation)[0]]).sum(axis=1)
    covariance = covariance + np.diag(np.repeat(apart, 3))
    return Prediction(along[0], turned_along[0], covariance)


def _taken_along(prior: Prior, local: Array) -> tuple[Array, Array]:
    """Of a new body: what each anchor has at landmarks that say so much (1, L), (E, 12), and by how
    many times its usual error that errs, (E,).

    What is nearest to an object takes it along (Darby et al. 2014, section 5.2): an anchor errs by
    so much more as the object is farther from it.
    """
    nearest = np.tensordot(local[0], prior.landmark_targets, axes=1)
    square = np.square(nearest[:, :3]).sum(axis=1)
    return nearest, square / max(float(square.min()), 1e-6)


def locality(kernel: Array) -> tuple[Array, Array]:
    """How much each landmark says of a body pose, (T, L), rows that sum to 1; and how near the
    nearest is, (T,), from 0 to 1; of the first view's kernel (T, L).

    Where all landmarks are too far away to tell which is nearer, they say the same.
    """
    nearest = kernel.max(axis=1)
    local = np.square((kernel + TINY) / (nearest + TINY)[:, None])
    return local / local.sum(axis=1, keepdims=True), np.square(nearest)


def weights_at(local: Array, products: Singles) -> Array:
    """The weights (T, E) of E predictions that keep the fused error least, none below 0.

    Of their errors' inner products (L, E, E) at landmarks that say so much, ``local`` (T, L).
    """
    return weights_of(at(local, products))


def at(local: Array, products: Singles) -> Array:
    """The products (T, E, E) that are expected, of those at landmarks (L, E, E)."""
    return (local @ products.reshape(len(products), -1)).reshape(-1, *products.shape[1:])


def weights_of(expected: Array) -> Array:
    """The weights (T, E) of E predictions whose errors have such inner products (T, E, E)."""
    own = np.einsum("tee->te", expected)
    expected = expected + np.einsum("te,ef->tef", DISTRUST * own + 1e-12, np.eye(len(own[0])))
    weights = np.linalg.solve(expected, np.ones((*own.shape, 1)))[..., 0]
    weights = np.maximum(weights, 0.0)
    return np.asarray(weights / weights.sum(axis=1, keepdims=True))


def fuse(
    predicted: Array,
    anchors: Anchors,
    height: Array | float,
    translation_weights: Array,
    rotation_weights: Array,
    spread: Array,
) -> tuple[Array, Array]:
    """Centres (T, 3) and rotations (T, 3, 3) from predictions (T, E, 12) in anchors (T, E)."""
    places = predicted[..., :3] * np.reshape(height, (-1, 1, 1))
    centres = anchors.origins + np.einsum("teij,tej->tei", anchors.axes, places)
    turns = anchors.axes @ predicted[..., 3:].reshape(*predicted.shape[:-1], 3, 3)
    mean_turn = np.einsum("te,teij->tij", rotation_weights, turns)
    return np.einsum("te,tei->ti", translation_weights, centres), nearest_rotation(
        mean_turn @ spread
    )


def covariance_at(local: Array, nearness: Array, errors: Array) -> Array:
    """The errors' second moments (T, 6, 6) at body poses to which landmarks say so much.

    Far from all landmarks the moments over all of them are added.
    """
    products = np.einsum("li,lj->lij", errors, errors)
    everywhere = products.mean(axis=0)
    here = (local @ products.reshape(len(errors), -1)).reshape(-1, 6, 6)
    return here + (BASE + 1.0 - nearness)[:, None, None] * everywhere


def nearest_rotation(matrices: Array) -> Array:
    """The rotation (..., 3, 3) nearest to each matrix: the orthogonal Procrustes problem."""
    left, _, right = np.linalg.svd(matrices)
    signs = np.ones((*matrices.shape[:-2], 3))
    signs[..., 2] = np.sign(np.linalg.det(left @ right))
    return np.asarray((left * signs[..., None, :]) @ right)


def repeated(anchors: Anchors, times: int) -> Anchors:
    """Anchors (T, times · A) of (A,) or (T, A): one after the other for each view."""
    origins = anchors.origins.reshape(-1, len(ANCHORS), 3)
    axes = anchors.axes.reshape(-1, len(ANCHORS), 3, 3)
    return Anchors(np.tile(origins, (1, times, 1)), np.tile(axes, (1, times, 1, 1)))


def rotation_error(estimated: Array, true: Array) -> Array:
    """Rotation vectors (..., 3) on the left that take true rotations (..., 3, 3) to estimated."""
    return rotations.to_vector(rotations.from_matrix(estimated @ np.swapaxes(true, -1, -2)))
