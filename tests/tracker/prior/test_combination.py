"""The combination of predictions: weights, covariances and rotations by their definitions."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from inhand_tracker.prior.combination import (
    combination_weights,
    covariance_at,
    locality,
    products_at,
    rotation_error,
    vertex_products,
)
from scipy.spatial.transform import Rotation


def weights_at(local: np.ndarray, products: np.ndarray) -> np.ndarray:
    return combination_weights(products_at(local, products.astype(np.float32)))


def test_landmarks_that_are_all_out_of_reach_say_the_same() -> None:
    local, nearness = locality(np.array([[0.0, 0.0, 0.0, 0.0], [1e-320, 0.0, 0.0, 0.0]]))
    np.testing.assert_allclose(local, 0.25)
    np.testing.assert_allclose(nearness, 0.0)


def test_independent_predictions_weigh_by_their_inverse_variance() -> None:
    variances = np.array([0.01, 0.02, 0.04])
    weights = weights_at(np.ones((1, 1)), np.diag(variances)[None])
    np.testing.assert_allclose(weights[0], np.array([4, 2, 1]) / 7, rtol=1e-5)


@given(st.integers(0, 200), st.integers(1, 8))
def test_weights_are_shares(seed: int, rank: int) -> None:
    errors = np.random.default_rng(seed).normal(size=(5, 6, rank))
    products = (errors @ np.swapaxes(errors, 1, 2)).astype(np.float32)
    weights = weights_at(np.full((2, 5), 0.2), products)
    assert (weights >= 0.0).all()
    np.testing.assert_allclose(weights.sum(axis=1), 1.0)


def test_predictions_without_error_weigh_the_same() -> None:
    weights = weights_at(np.ones((1, 1)), np.zeros((1, 4, 4), np.float32))
    np.testing.assert_allclose(weights, 0.25)


def test_no_other_shares_combine_correlated_predictions_better() -> None:
    """The first two err alike: together they get about what one of them would get alone."""
    products = np.array([[[1.0, 0.9, 0.0], [0.9, 1.0, 0.0], [0.0, 0.0, 1.0]]])
    (weights,) = combination_weights(products, distrust=0.0)
    random = np.random.default_rng(0)
    others = random.dirichlet(np.ones(3), size=500)
    variances = np.einsum("te,ef,tf->t", others, products[0], others)
    assert weights @ products[0] @ weights <= variances.min()
    np.testing.assert_allclose(weights, [0.256, 0.256, 0.487], atol=1e-3)


def test_the_covariance_is_that_of_the_landmarks_near_by() -> None:
    errors = np.eye(6)[[0, 1]] * [[2.0], [1.0]]
    local = np.array([[1.0, 0.0], [0.25, 0.75]])
    near, mixed = covariance_at(local, np.ones(2), errors, everywhere_share=0.0)
    np.testing.assert_allclose(np.diag(near)[:2], [4.0, 0.0])
    np.testing.assert_allclose(np.diag(mixed)[:2], [1.0, 0.75])


def test_far_from_all_landmarks_their_mean_covariance_is_added() -> None:
    errors = np.eye(6)[[0, 1]] * [[2.0], [1.0]]
    (far,) = covariance_at(np.array([[1.0, 0.0]]), np.zeros(1), errors, everywhere_share=0.1)
    np.testing.assert_allclose(np.diag(far)[:2], [4.0 + 1.1 * 2.0, 1.1 * 0.5])


def test_the_rotation_error_takes_the_truth_to_the_estimate() -> None:
    true, error = Rotation.from_rotvec([0.5, -1.0, 0.3]), np.array([0.1, 0.2, -0.3])
    estimated = Rotation.from_rotvec(error) * true
    np.testing.assert_allclose(rotation_error(estimated.as_matrix(), true.as_matrix()), error)


def test_the_product_of_two_errors_is_that_of_how_far_they_take_vertices() -> None:
    """To first order, and in the mean over the axes of rotations."""
    random = np.random.default_rng(4)
    vertices = random.normal(size=(20000, 3)) * 0.2
    spread = vertices.T @ vertices / len(vertices)
    one, other = random.normal(size=(2, 1, 6)) * 0.1

    def moved(error: np.ndarray) -> np.ndarray:
        return error[0, :3] + np.cross(error[0, 3:], vertices)

    expected = (moved(one) * moved(other)).sum(axis=1).mean()
    np.testing.assert_allclose(vertex_products(one, other, spread), expected, rtol=0.05)
