"""Where an object is, from the body alone: many predictions, fused by how well each does here.

A kernel regression predicts the object in each anchor of the body (``anchors``), from each view of
the body's last moments (``window``). Where predictions were wrong, and how their errors went
together, is known from people who were held out in training. So those of like body poses give the
weights of the best linear unbiased combination (``combination``), and the covariance of what comes
out.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from inhand_tracker.body.anchors import Anchors
from inhand_tracker.geometry.arrays import Array, Indices, Singles
from inhand_tracker.prior.combination import (
    TINY,
    combination_weights,
    covariance_at,
    fuse,
    locality,
)
from inhand_tracker.prior.hold import Hold, held_in
from inhand_tracker.prior.kernel_ridge import KernelRidge
from inhand_tracker.prior.parameters import DEFAULT_PRIOR, PriorParameters
from inhand_tracker.prior.prediction import Prediction, between, in_camera

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
    seen to move it, or in priors of older releases.
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

    def products_at(self, local: Array) -> Array:
        """The lower triangles (2, E, E) of both products that are expected, by landmarks' shares
        (L,)."""
        count = self.translation_products.shape[-1]
        expected = np.zeros((2, count, count))
        expected[:, *self._lower] = (local.astype(np.float32) @ self._triangles).reshape(2, -1)
        return expected


def predict(
    prior: Prior,
    descriptions: Sequence[Singles],
    anchors: Anchors,
    height: float,
    parameters: PriorParameters = DEFAULT_PRIOR,
) -> Prediction:
    """Predict the object's pose for one body: descriptions (1, D) of each view, its anchors and
    height."""
    kernels = [
        regression.kernel_of(description[0])
        for regression, description in zip(prior.regressions, descriptions, strict=True)
    ]
    nearest = [float(kernel.max()) for kernel in kernels]
    stretches = [max(parameters.farthest_kernel / max(one, TINY), 1.0) for one in nearest]
    local, nearness = locality(kernels[0])
    weights = combination_weights(prior.products_at(local), parameters.distrust)
    predicted = _predicted(prior, kernels, stretches)
    centre, rotation = fuse(predicted, anchors, height, (weights[0], weights[1]), prior.spread)
    doubt = min(max(stretches[0], 1.0), parameters.most_stretched) ** 2
    covariance = covariance_at(local, nearness, prior.errors, parameters.everywhere_share)
    scaled = doubt * prior.calibration * covariance
    usual = Prediction(centre, rotation, in_camera(scaled, anchors.axes[0], height))
    novelty = _novelty(nearest[0], parameters)
    if novelty == 0.0 or prior.hold is None:
        return usual
    held = held_in(prior.hold, anchors, height)
    return between(usual, held, novelty, parameters.held_doubt)


def _novelty(nearest: float, parameters: PriorParameters) -> float:
    """How new a body is, from 0 to 1, by its kernel to the nearest landmark."""
    span = parameters.new_kernel - parameters.strange_kernel
    return float(np.clip((parameters.new_kernel - nearest) / max(span, TINY), 0.0, 1.0))


def _predicted(prior: Prior, kernels: list[Array], stretches: list[float]) -> Array:
    """What every regression predicts in every anchor, (E, 12), by kernels (L,) that are stretched
    where all landmarks are far away."""
    predicted = [
        regression.predict_by(stretch * kernel)
        for stretch, kernel, regression in zip(stretches, kernels, prior.regressions, strict=True)
    ]
    return np.concatenate(predicted).reshape(-1, TARGETS)
