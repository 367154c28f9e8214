"""The best linear unbiased combination of predictions, by how their errors went together.

E predictions of an object's centre and rotation, each in an anchor of the body, are fused for T
bodies at once. What is known of errors is kept at L landmarks among body poses.
"""

import numpy as np

from inhand_tracker.body.anchors import ANCHORS, Anchors
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Singles
from inhand_tracker.prior.parameters import DEFAULT_PRIOR

TINY = 1e-300
"""Number in place of nothing where landmarks are compared that are all out of reach."""


def locality(kernel: Array) -> tuple[Array, Array]:
    """Weight each landmark by a kernel (T, L): shares (T, L), rows that sum to 1; and how near the
    nearest is, (T,), from 0 to 1.

    Where all landmarks are too far away for one to be nearer, their shares are the same.
    """
    nearest = kernel.max(axis=1)
    local = np.square((kernel + TINY) / (nearest + TINY)[:, None])
    return local / local.sum(axis=1, keepdims=True), np.square(nearest)


def products_at(local: Array, products: Singles) -> Array:
    """The inner products of errors (T, E, E) that are expected, of those at landmarks (L, E, E)."""
    return (local @ products.reshape(len(products), -1)).reshape(-1, *products.shape[1:])


def combination_weights(products: Array, distrust: float = DEFAULT_PRIOR.distrust) -> Array:
    """The weights (T, E) of E predictions that keep the fused error least, none below 0.

    Their errors have the inner products (T, E, E); to each its own is added once more, times
    ``distrust``.
    """
    own = np.einsum("tee->te", products)
    products = products + np.einsum("te,ef->tef", distrust * own + 1e-12, np.eye(len(own[0])))
    weights = np.linalg.solve(products, np.ones((*own.shape, 1)))[..., 0]
    weights = np.maximum(weights, 0.0)
    return np.asarray(weights / weights.sum(axis=1, keepdims=True))


def fuse(
    predicted: Array,
    anchors: Anchors,
    height: Array | float,
    weights: tuple[Array, Array],
    spread: Array,
) -> tuple[Array, Array]:
    """Centres (T, 3) and rotations (T, 3, 3) from predictions (T, E, 12) in anchors (T, E).

    ``weights`` of translations and of rotations, each (T, E); ``spread`` (3, 3) is the covariance
    of the object's marked vertices, by which rotations differ.
    """
    translation_weights, rotation_weights = weights
    places = predicted[..., :3] * np.reshape(height, (-1, 1, 1))
    centres = anchors.origins + np.einsum("teij,tej->tei", anchors.axes, places)
    turns = anchors.axes @ predicted[..., 3:].reshape(*predicted.shape[:-1], 3, 3)
    mean_turn = np.einsum("te,teij->tij", rotation_weights, turns)
    return np.einsum("te,tei->ti", translation_weights, centres), nearest_rotation(
        mean_turn @ spread
    )


def covariance_at(
    local: Array,
    nearness: Array,
    errors: Array,
    everywhere_share: float = DEFAULT_PRIOR.everywhere_share,
) -> Array:
    """The second moments (T, 6, 6) of errors (L, 6) at body poses, by landmarks' shares (T, L).

    A share of the moments over all landmarks is added, and far from all of them the whole.
    """
    products = np.einsum("li,lj->lij", errors, errors)
    everywhere = products.mean(axis=0)
    here = (local @ products.reshape(len(errors), -1)).reshape(-1, 6, 6)
    return here + (everywhere_share + 1.0 - nearness)[:, None, None] * everywhere


def nearest_rotation(matrices: Array) -> Array:
    """The rotation (..., 3, 3) nearest to each matrix: the orthogonal Procrustes problem."""
    left, _, right = np.linalg.svd(matrices)
    signs = np.ones((*matrices.shape[:-2], 3))
    signs[..., 2] = np.sign(np.linalg.det(left @ right))
    return np.asarray((left * signs[..., None, :]) @ right)


def rotation_error(estimated: Array, true: Array) -> Array:
    """Rotation vectors (..., 3) on the left that take true rotations (..., 3, 3) to estimated."""
    return rotations.to_vector(rotations.from_matrix(estimated @ np.swapaxes(true, -1, -2)))


def repeated(anchors: Anchors, times: int) -> Anchors:
    """Anchors (T, times · A) of (A,) or (T, A): one after the other for each view."""
    origins = anchors.origins.reshape(-1, len(ANCHORS), 3)
    axes = anchors.axes.reshape(-1, len(ANCHORS), 3, 3)
    return Anchors(np.tile(origins, (1, times, 1)), np.tile(axes, (1, times, 1, 1)))
