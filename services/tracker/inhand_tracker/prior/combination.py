"""The best linear unbiased combination of predictions, by how their errors went together.

E predictions of an object's centre and rotation, each in an anchor of the body, are fused for T
bodies at once. What is known of errors is kept at L landmarks among body poses.
"""

import numpy as np

from inhand_tracker.body.anchors import Anchors
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Singles
from inhand_tracker.prior.kernels import combine as kernels
from inhand_tracker.prior.parameters import DEFAULT_PRIOR

TINY = 1e-300
"""Number in place of nothing where landmarks are compared that are all out of reach."""


def locality(kernel: Array) -> tuple[Array, Array]:
    """Weight each landmark by a kernel (..., L): shares (..., L) that sum to 1; and how near the
    nearest is, (...,), from 0 to 1.

    Where all landmarks are too far away for one to be nearer, their shares are the same.
    """
    nearest = kernel.max(axis=-1, keepdims=True)
    local = np.square((kernel + TINY) / (nearest + TINY))
    return local / local.sum(axis=-1, keepdims=True), np.square(nearest[..., 0])


def products_at(local: Array, products: Singles) -> Array:
    """The inner products of errors (..., E, E) that are expected, of those at landmarks (L, E, E),
    by their shares (..., L)."""
    flat = local.astype(np.float32) @ products.reshape(len(products), -1)
    return flat.astype(np.float64).reshape(*local.shape[:-1], *products.shape[1:])


def combination_weights(products: Array, distrust: float = DEFAULT_PRIOR.distrust) -> Array:
    """The weights (..., E) of E predictions that keep the fused error least, none below 0.

    Their errors have the inner products (..., E, E), of which the lower triangles are read; to each
    its own is added once more, times ``distrust``.
    """
    return kernels.best_weights(products, distrust)


def fuse(
    predicted: Array,
    anchors: Anchors,
    height: Array | float,
    weights: tuple[Array, Array],
    spread: Array,
) -> tuple[Array, Array]:
    """Centres (..., 3) and rotations (..., 3, 3) from predictions (..., E, 12) in anchors (..., A),
    in turns.

    ``weights`` of translations and of rotations, each (..., E); ``spread`` (3, 3) is the covariance
    of the object's marked vertices, by which rotations differ.
    """
    fused: tuple[Array, Array] = kernels.fused(
        predicted, anchors.origins, anchors.axes, height, *weights, spread
    )
    return fused


def covariance_at(
    local: Array,
    nearness: Array | float,
    errors: Array,
    everywhere_share: float = DEFAULT_PRIOR.everywhere_share,
) -> Array:
    """The second moments (..., 6, 6) of errors (L, 6) at body poses, by landmarks' shares (..., L).

    A share of the moments over all landmarks is added, and far from all of them the whole.
    """
    return kernels.moments_at(local, nearness, errors, everywhere_share)


def widened(covariances: Array, share: float) -> Array:
    """Add to covariances (..., 6, 6) a share of what they are on average in any direction.

    Errors of few people, or of few recordings, point in few directions; in the others it is not
    known how large the next one's are. Translations and rotations each by themselves.
    """
    return kernels.widened(covariances, share)


def lower_triangles(triangles: Singles, count: int) -> Array:
    """Put the lower triangles (..., T), row by row, into matrices (..., E, E) for a count E."""
    return kernels.lower_triangles(triangles.astype(np.float64), np.empty(count))


def vertex_products(one: Array, other: Array, spread: Array) -> Array:
    """Mean inner products (T,), in m², of how far two errors (T, 6), in metres and radians, take
    marked vertices of covariance ``spread`` (3, 3), rotations about any axis."""
    products = one * other
    return products[:, :3].sum(axis=1) + 2.0 / 3.0 * np.trace(spread) * products[:, 3:].sum(axis=1)


def rotation_error(estimated: Array, true: Array) -> Array:
    """Rotation vectors (..., 3) on the left that take true rotations (..., 3, 3) to estimated."""
    return rotations.to_vector(rotations.from_matrix(estimated @ np.swapaxes(true, -1, -2)))
