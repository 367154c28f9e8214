"""Where an object is, from the body alone: many predictions, fused by how well each does here.

A kernel regression predicts the object in each anchor of the body (``anchors``), from each view of
the body's last moments (``window``). Where predictions were wrong, and how their errors went
together, is known from people who were held out in training. So those of like body poses give the
weights of the best linear unbiased combination (``combination``), and the covariance of what comes
out.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from inhand_schemas.joints import JOINT_NAMES

from inhand_tracker.body.anchors import Anchors
from inhand_tracker.geometry.arrays import Array, Indices, Singles
from inhand_tracker.prior.calibration import widened
from inhand_tracker.prior.combination import (
    TINY,
    combination_weights,
    covariance_at,
    fuse,
    locality,
)
from inhand_tracker.prior.hold import Hold
from inhand_tracker.prior.kernel_ridge import KernelRidge, usual_width
from inhand_tracker.prior.kernels.distances import least_distance
from inhand_tracker.prior.parameters import DEFAULT_PRIOR, PriorParameters
from inhand_tracker.prior.prediction import Prediction, between, in_camera

POSTURE = 3 * len(JOINT_NAMES)
"""Numbers at the beginning of a whole body's description that say where its joints are."""
TARGETS = 12
"""Numbers that are predicted in each anchor: the object's centre, in body heights, then its
rotation matrix, row by row."""


@dataclass(frozen=True)
class Prior:
    """What was learned of one object's poses, as of right-handed people; L landmarks.

    ``centre`` (3,) and ``spread`` (3, 3) are mean and covariance of the marked vertices.
    ``regressions`` (V of them) predict (A * 12). ``translation_products`` and
    ``rotation_products`` (L, V A, V A) are the inner products of the predictions' held-out errors
    at each landmark; ``errors`` (L, 6) those of the fused estimate, translation of the centre in
    body heights and rotation vector on the left, in the trunk's axes. ``calibration`` scales the
    covariance so that nine in ten held-out errors lie within its 90 % region. ``persistence_s``
    is how long an error lasts. ``hold`` is how the object is held or worn; None where nobody was
    seen to move it, or in priors of older releases. ``widening`` is the share by which a covariance
    is widened in all directions, since few people were seen.
    """

    centre: Array
    spread: Array
    regressions: tuple[KernelRidge, ...]
    translation_products: Singles
    rotation_products: Singles
    errors: Array
    calibration: float
    persistence_s: float
    hold: Hold | None = None
    widening: float = 0.0

    @cached_property
    def _lower(self) -> tuple[Indices, Indices]:
        """Rows and columns (T,) of a lower triangle."""
        return np.tril_indices(self.translation_products.shape[-1])

    @cached_property
    def _triangles(self) -> Singles:
        """The lower triangles (L, 2 T) of both products side by side: they are symmetric, and what
        is read for each body is half as much."""
        both = self.translation_products, self.rotation_products
        return np.concatenate([products[:, *self._lower] for products in both], axis=1)

    @cached_property
    def _postures(self) -> tuple[Singles, float]:
        """The landmarks' postures (L, 60) by themselves, without movement, and the squared width of
        a kernel among them."""
        landmarks = np.ascontiguousarray(self.regressions[0].landmarks[:, :POSTURE])
        return landmarks, usual_width(landmarks)

    def nearest_posture(self, described: Singles) -> float:
        """Find the kernel, from 0 to 1, between a body described whole (D,) and the landmark of the
        nearest posture: who moves as nobody did may well stand as somebody did."""
        landmarks, width = self._postures
        return math.exp(least_distance(described[:POSTURE], landmarks) / (-2.0 * width))

    def products_at(self, local: Array) -> Array:
        """The lower triangles (2, E, E) of both products that are expected, by landmarks' shares
        (L,)."""
        count = self.translation_products.shape[-1]
        expected = np.zeros((2, count, count))
        expected[:, *self._lower] = (local.astype(np.float32) @ self._triangles).reshape(2, -1)
        return expected

    @cached_property
    def landmark_targets(self) -> Array:
        """(L, V A, 12): the object in each anchor at each landmark, as each regression has it."""
        fitted = [one.predict(one.landmarks) for one in self.regressions]
        return np.concatenate([one.reshape(len(one), -1, TARGETS) for one in fitted], axis=1)


def predict(
    prior: Prior,
    descriptions: Sequence[Singles],
    anchors: Anchors,
    height: float,
    parameters: PriorParameters = DEFAULT_PRIOR,
) -> Prediction:
    """Predict the object's pose for one body: descriptions (1, D) of each view, its anchors and
    height.

    By what people did in such postures; of a posture unlike all of theirs by how they hold it.
    """
    regressed = _regressed(prior, descriptions, anchors, height, parameters)
    if prior.hold is None:
        return regressed
    nearest = prior.nearest_posture(descriptions[0][0])
    share = _strangeness(nearest, parameters)
    if share == 0.0:
        return regressed
    held = prior.hold.of(anchors)
    grown = _growth(nearest, parameters) * held.covariance
    held = Prediction(held.centre, held.rotation, grown)
    return between(regressed, held, share, doubt=parameters.held_doubt)


def _strangeness(nearest: float, parameters: PriorParameters) -> float:
    """How strange a posture is, from 0 to 1, by its kernel to the nearest one."""
    familiar, strange = parameters.familiar_posture, parameters.strange_posture
    return min(max((familiar - nearest) / max(familiar - strange, TINY), 0.0), 1.0)


def _growth(nearest: float, parameters: PriorParameters) -> float:
    """How much the hold's covariance grows: with the distance from the nearest posture, beyond that
    at which nothing but the hold counts, as limbs may lie elsewhere too."""
    square = math.log(max(nearest, TINY)) / math.log(parameters.strange_posture)
    return min(math.sqrt(max(square, 1.0)), parameters.most_stretched**2)


def _regressed(
    prior: Prior,
    descriptions: Sequence[Singles],
    anchors: Anchors,
    height: float,
    parameters: PriorParameters,
) -> Prediction:
    """Predict by the regressions."""
    kernels = [
        regression.kernel_of(description[0])
        for regression, description in zip(prior.regressions, descriptions, strict=True)
    ]
    nearest = [float(kernel.max()) for kernel in kernels]
    stretches = [max(parameters.farthest_kernel / max(one, TINY), 1.0) for one in nearest]
    local, nearness = locality(kernels[0])
    here = _Predictions(
        _predicted(prior, kernels, stretches),
        anchors,
        height,
        prior.products_at(local),
    )
    centre, rotation = here.fused(prior.spread, parameters.distrust)
    doubt = min(max(stretches[0], 1.0), parameters.most_stretched) ** 2
    covariance = covariance_at(local, nearness, prior.errors, parameters.everywhere_share)
    scaled = doubt * prior.calibration * widened(covariance, prior.widening)
    usual = Prediction(centre, rotation, in_camera(scaled, anchors.axes[0], height))
    novelty = 1.0 - nearest[0] / parameters.new_kernel
    if novelty <= 0.0:
        return usual
    targets = prior.landmark_targets
    at_nearest = (local @ targets.reshape(len(local), -1)).reshape(targets.shape[1:])
    taken = here.taken_along(novelty, at_nearest)
    moved = Prediction(*taken.fused(prior.spread, parameters.distrust), usual.covariance)
    return between(usual, moved, 1.0, around=1.0)


@dataclass(frozen=True)
class _Predictions:
    """All predictions for one body, E of them.

    ``predicted`` (E, 12) in ``anchors`` (A,), and the lower triangles (2, E, E) of the expected
    inner ``products`` of the errors of translations and rotations.
    """

    predicted: Array
    anchors: Anchors
    height: float
    products: Array

    def fused(self, spread: Array, distrust: float) -> tuple[Array, Array]:
        """The centre (3,) and rotation (3, 3) of their best combination."""
        weights = combination_weights(self.products, distrust)
        return fuse(self.predicted, self.anchors, self.height, (weights[0], weights[1]), spread)

    def taken_along(self, novelty: float, nearest: Array) -> "_Predictions":
        """The same for a new body, the more different the newer it is, ``novelty`` from 0 to 1.

        What is nearest to an object takes it along (Darby et al. 2014, section 5.2): each anchor
        predicts what it has at the nearest landmarks, (E, 12), and its error grows with the square
        of the object's distance from it.
        """
        square = np.square(nearest[:, :3]).sum(axis=1)
        shares = square / max(float(square.min()), 1e-6)
        worse = 1.0 + novelty * (shares - 1.0)
        return replace(
            self,
            predicted=self.predicted + novelty * (nearest - self.predicted),
            products=np.stack((worse[:, None] * self.products[0] * worse, self.products[1])),
        )


def _predicted(prior: Prior, kernels: list[Array], stretches: list[float]) -> Array:
    """What every regression predicts in every anchor, (E, 12), by kernels (L,) that are stretched
    where all landmarks are far away."""
    predicted = [
        regression.predict_by(stretch * kernel)
        for stretch, kernel, regression in zip(stretches, kernels, prior.regressions, strict=True)
    ]
    return np.concatenate(predicted).reshape(-1, TARGETS)
