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
from inhand_tracker.geometry.arrays import Array, Singles
from inhand_tracker.prior.combination import (
    TINY,
    combination_weights,
    covariance_at,
    fuse,
    locality,
    lower_triangles,
    widened,
)
from inhand_tracker.prior.hold import Hold
from inhand_tracker.prior.kernel_ridge import KernelRidge, usual_width
from inhand_tracker.prior.kernels.distances import distances_of, nearest_of
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
    def _triangles(self) -> Singles:
        """The lower triangles (L, 2 T) of both products side by side: they are symmetric, and what
        is read for each body is half as much."""
        both = self.translation_products, self.rotation_products
        lower = np.tril_indices(self.translation_products.shape[-1])
        return np.concatenate([products[:, *lower] for products in both], axis=1)

    @cached_property
    def _postures(self) -> tuple[Singles, float]:
        """The landmarks' postures (L, 60) by themselves, without movement, and the squared width of
        a kernel among them."""
        landmarks = np.ascontiguousarray(self.regressions[0].landmarks[:, :POSTURE])
        return landmarks, usual_width(landmarks)

    def posture_of(self, described: Singles, hold: Hold) -> "_Posture":
        """Compare the posture of a body described whole (D,) with those of the landmarks: who moves
        as nobody did may well stand as somebody did."""
        landmarks, width = self._postures
        distances = distances_of(described[:POSTURE], landmarks)
        least, towards, square = nearest_of(distances, width, hold.leanings)
        share = min(max(towards / max(square, TINY), 0.0), 1.0)
        return _Posture(math.exp(least / (-2.0 * width)), share)

    def products_at(self, local: Array) -> Array:
        """The lower triangles (2, E, E) of both products that are expected, by landmarks' shares
        (L,)."""
        count = self.translation_products.shape[-1]
        triangles = (local.astype(np.float32) @ self._triangles).reshape(2, -1)
        return lower_triangles(triangles, count)

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
    """Predict the object's pose for one body, as ``predict_both`` does, by both together."""
    return predict_both(prior, descriptions, anchors, height, parameters).whole


@dataclass(frozen=True)
class BothPredictions:
    """What is predicted by what people did and how they hold the object, together, ``whole``, and
    by what they did alone, ``regressed``; and how strange the posture is, from 0 to 1."""

    whole: Prediction
    regressed: Prediction
    strangeness: float


def predict_both(
    prior: Prior,
    descriptions: Sequence[Singles],
    anchors: Anchors,
    height: float,
    parameters: PriorParameters = DEFAULT_PRIOR,
) -> BothPredictions:
    """Predict the object's pose for one body: descriptions (1, D) of each view, its anchors and
    height.

    By what people did in such postures, as far towards how they hold the object as was best there
    for people who were held out, in least squares; and of a posture unlike all of theirs by how
    they hold it alone.
    """
    kernels = [
        regression.kernel_of(description[0])
        for regression, description in zip(prior.regressions, descriptions, strict=True)
    ]
    local, nearness = locality(kernels[0])
    regressed = _regressed(
        prior, kernels, _Locality(local, float(nearness)), anchors, height, parameters
    )
    if prior.hold is None:
        return BothPredictions(regressed, regressed, 0.0)
    posture = prior.posture_of(descriptions[0][0], prior.hold)
    strangeness = posture.strangeness(parameters)
    share = max(strangeness, posture.held_share)
    if share == 0.0:
        return BothPredictions(regressed, regressed, 0.0)
    held = prior.hold.of(anchors, posture.growth(parameters))
    whole = between(regressed, held, share, doubt=parameters.held_doubt)
    return BothPredictions(whole, regressed, strangeness)


def predict_apart(
    prior: Prior,
    description: Singles,
    anchors: Anchors,
    height: float,
    parameters: PriorParameters = DEFAULT_PRIOR,
) -> list[Prediction]:
    """Predict the object's pose in each of A anchors by itself, from the whole body's description
    (1, D); how sure they are is not told: their covariances are 0."""
    regression = prior.regressions[0]
    kernel = regression.kernel_of(description[0])
    stretch = _stretch(float(kernel.max()), parameters)
    predicted = regression.predict_by(stretch * kernel).reshape(-1, TARGETS)
    return [
        Prediction(
            *fuse(predicted, anchors, height, (weight, weight), prior.spread), np.zeros((6, 6))
        )
        for weight in np.eye(len(predicted))
    ]


@dataclass(frozen=True)
class _Posture:
    """A body's posture beside those that were learned: the kernel to the ``nearest`` of them, from
    0 to 1, and ``held_share``, how far of the way from the regressions to the hold the truth was
    around there, of people who were held out, in least squares, from 0 to 1."""

    nearest: float
    held_share: float

    def strangeness(self, parameters: PriorParameters) -> float:
        """How strange the posture is, from 0 to 1."""
        familiar, strange = parameters.familiar_posture, parameters.strange_posture
        return min(max((familiar - self.nearest) / max(familiar - strange, TINY), 0.0), 1.0)

    def growth(self, parameters: PriorParameters) -> float:
        """How much the hold's covariance grows: with the distance from the nearest posture, beyond
        that at which nothing but the hold counts, as limbs may lie elsewhere too."""
        square = math.log(max(self.nearest, TINY)) / math.log(parameters.strange_posture)
        return min(math.sqrt(max(square, 1.0)), parameters.most_stretched**2)


@dataclass(frozen=True)
class _Locality:
    """Landmarks' shares (L,) at a body, and how near the nearest of them is, from 0 to 1."""

    shares: Array
    nearness: float


def _regressed(
    prior: Prior,
    kernels: list[Array],
    at: _Locality,
    anchors: Anchors,
    height: float,
    parameters: PriorParameters,
) -> Prediction:
    """Predict by the regressions, by their kernels (L,) at a body."""
    nearest = [float(kernel.max()) for kernel in kernels]
    stretches = [_stretch(one, parameters) for one in nearest]
    here = _Predictions(
        _predicted(prior, kernels, stretches),
        anchors,
        height,
        prior.products_at(at.shares),
    )
    centre, rotation = here.fused(prior.spread, parameters.distrust)
    doubt = min(max(stretches[0], 1.0), parameters.most_stretched) ** 2
    covariance = covariance_at(at.shares, at.nearness, prior.errors, parameters.everywhere_share)
    scaled = doubt * prior.calibration * widened(covariance, prior.widening)
    usual = Prediction(centre, rotation, in_camera(scaled, anchors.axes[0], height))
    novelty = 1.0 - nearest[0] / parameters.new_kernel
    if novelty <= 0.0:
        return usual
    targets = prior.landmark_targets
    at_nearest = (at.shares @ targets.reshape(len(targets), -1)).reshape(targets.shape[1:])
    taken = here.taken_along(novelty, at_nearest)
    moved = Prediction(*taken.fused(prior.spread, parameters.distrust), usual.covariance)
    return between(usual, moved, 1.0, around=1.0)


def _stretch(nearest: float, parameters: PriorParameters) -> float:
    """The factor on kernels where the ``nearest`` landmark's is small, as all are far away."""
    return max(parameters.farthest_kernel / max(nearest, TINY), 1.0)


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
