"""Small symmetric matrices: roots, solutions, inverses, principal vectors, as they are defined."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from inhand_tracker.geometry.kernels.matrices import find_root, invert, solve
from inhand_tracker.geometry.kernels.nearest_rotation import principal_vector

seeds, sizes = st.integers(0, 10_000), st.integers(1, 9)


def positive(seed: int, size: int) -> np.ndarray:
    """A covariance whose deviations differ by a factor of up to a thousand."""
    random = np.random.default_rng(seed)
    turn, _ = np.linalg.qr(random.normal(size=(size, size)))
    return turn @ np.diag(10.0 ** random.uniform(-6.0, 0.0, size)) @ turn.T


@given(seeds, sizes)
def test_a_root_times_itself_is_the_matrix_and_solves_it(seed: int, size: int) -> None:
    matrix = positive(seed, size)
    root = np.zeros((size, size))
    assert find_root(matrix, root)
    np.testing.assert_allclose(root @ root.T, matrix, rtol=1e-9, atol=1e-15)
    wanted = np.random.default_rng(seed).normal(size=size)
    vector = matrix @ wanted
    solve(root, vector)
    np.testing.assert_allclose(vector, wanted, rtol=1e-6, atol=1e-6)
    inverse = np.empty((size, size))
    invert(root, inverse)
    np.testing.assert_allclose(inverse @ matrix, np.eye(size), atol=1e-6)


@pytest.mark.parametrize(
    "matrix", [np.diag([1.0, -1.0]), np.zeros((2, 2)), np.full((2, 2), np.nan)]
)
def test_what_is_not_positive_definite_has_no_root(matrix: np.ndarray) -> None:
    assert not find_root(matrix, np.empty((2, 2)))


@given(seeds, sizes)
def test_the_principal_vector_is_stretched_most(seed: int, size: int) -> None:
    random = np.random.default_rng(seed)
    matrix = random.normal(size=(size, size))
    matrix = matrix + matrix.T
    found = principal_vector(matrix.copy())
    assert np.linalg.norm(found) == pytest.approx(1.0)
    assert found @ matrix @ found == pytest.approx(np.linalg.eigvalsh(matrix)[-1], abs=1e-9)


@pytest.mark.parametrize("tiny", [0.0, 1e-200, 1e-320])
def test_elements_next_to_nothing_do_no_harm(tiny: float) -> None:
    matrix = np.diag([1.0, 2.0, 3.0, 1.0])
    matrix[0, 2] = matrix[2, 0] = tiny
    np.testing.assert_allclose(np.abs(principal_vector(matrix)), [0.0, 0.0, 1.0, 0.0], atol=1e-12)
