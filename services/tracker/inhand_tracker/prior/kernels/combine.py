"""Combining E predictions of one body, and what is expected of their errors at L landmarks."""

import numpy as np
from inhand_runtime.compiled import vectorised

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.kernels.matrices import find_root, solve
from inhand_tracker.geometry.kernels.nearest_rotation import nearest_rotation

MOST_RIDGE = 1e3
"""Ridge at which products that are no products (NaN) are given up; the weights are NaN then."""


@vectorised("(e,e),()->(e)")
def best_weights(products: Array, distrust: float, weights: Array) -> None:
    """Fill ``weights`` (E,) with the shares of predictions, 0 or more, that keep the fused error
    least, where their errors have inner products (E, E)."""
    root = np.empty_like(products)
    ridge = distrust
    while True:
        root[:] = products
        for one in range(len(root)):
            root[one, one] += ridge * products[one, one] + 1e-12
        if find_root(root, root) or not ridge < MOST_RIDGE:
            break
        ridge = 10.0 * ridge + 1e-6  # rounding: the products are those of errors
    weights[:] = 1.0
    solve(root, weights)
    total = 0.0
    for one in range(len(root)):
        weights[one] = max(weights[one], 0.0)
        total += weights[one]
    for one in range(len(root)):
        weights[one] /= total


@vectorised("(e,t),(a,v),(a,v,v),(),(e),(e),(v,v)->(v),(v,v)")
def fused(
    predicted: Array,
    origins: Array,
    axes: Array,
    height: float,
    translation_weights: Array,
    rotation_weights: Array,
    spread: Array,
    centre: Array,
    rotation: Array,
) -> None:
    """Fill ``centre`` (3,) and ``rotation`` (3, 3) from predictions (E, 12) in A anchors, in turns.

    Rotations differ by how far they take points of covariance ``spread`` (3, 3).
    """
    centre[:] = 0.0
    mean = np.zeros((3, 3))
    for one in range(len(predicted)):
        anchor = one % len(origins)
        at, turning = translation_weights[one], rotation_weights[one]
        for row in range(3):
            place = origins[anchor, row]
            for k in range(3):
                axis = axes[anchor, row, k]
                place += height * axis * predicted[one, k]
                for column in range(3):
                    mean[row, column] += turning * axis * predicted[one, 3 + 3 * k + column]
            centre[row] += at * place
    matrix = np.zeros((3, 3))
    for row in range(3):
        for column in range(3):
            for k in range(3):
                matrix[row, column] += mean[row, k] * spread[k, column]
    nearest_rotation(matrix, rotation)


@vectorised("(l),(),(l,i),()->(i,i)")
def moments_at(
    local: Array, nearness: float, errors: Array, everywhere_share: float, moments: Array
) -> None:
    """Fill ``moments`` (6, 6) with those of errors (L, 6) by landmarks' shares (L,), and a share
    of those over all landmarks, the whole of it far from all."""
    moments[:] = 0.0
    everywhere = (everywhere_share + 1.0 - nearness) / len(local)
    for landmark in range(len(local)):
        share = local[landmark] + everywhere
        for one in range(moments.shape[0]):
            scaled = share * errors[landmark, one]
            for other in range(one + 1):
                moments[one, other] += scaled * errors[landmark, other]
    for one in range(moments.shape[0]):
        for other in range(one):
            moments[other, one] = moments[one, other]


@vectorised("(i,i),()->(i,i)")
def widened(covariance: Array, share: float, wider: Array) -> None:
    """Fill ``wider`` (6, 6) with a covariance and a share of its mean variance in each block."""
    wider[:] = covariance
    for first in range(0, 6, 3):
        usual = 0.0
        for axis in range(first, first + 3):
            usual += covariance[axis, axis] / 3.0
        for axis in range(first, first + 3):
            wider[axis, axis] += share * usual


@vectorised("(t),(e)->(e,e)")
def lower_triangles(triangle: Array, count: Array, matrix: Array) -> None:
    """Fill the lower triangle of ``matrix`` (E, E), row by row, and the rest with 0."""
    matrix[:] = 0.0
    index = 0
    for row in range(len(count)):
        for column in range(row + 1):
            matrix[row, column] = triangle[index]
            index += 1
