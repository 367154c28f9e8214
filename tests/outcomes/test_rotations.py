"""Quaternions beside SciPy's."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from inhand_outcomes.rotations import (
    conjugate,
    matrices,
    multiply,
    of_matrix,
    rotation_vectors,
)
from scipy.spatial.transform import Rotation

OFF = np.array([7e-3, 1.3e-3, 0.0, 0.0])
"""Keeps rows of zeros from having no length."""
quaternions = arrays(np.float64, (5, 4), elements=st.floats(-1.0, 1.0)).map(
    lambda rows: (rows + OFF) / np.linalg.norm(rows + OFF, axis=1, keepdims=True)
)


def scipys(rows: np.ndarray) -> Rotation:
    return Rotation.from_quat(rows, scalar_first=True)


@given(quaternions, quaternions)
def test_they_agree_with_scipy(first: np.ndarray, second: np.ndarray) -> None:
    np.testing.assert_allclose(matrices(first), scipys(first).as_matrix(), atol=1e-9)
    product = multiply(first, conjugate(second))
    theirs = scipys(first) * scipys(second).inv()
    np.testing.assert_allclose(matrices(product), theirs.as_matrix(), atol=1e-9)
    assert (product[:, 0] >= 0.0).all()
    vectors = rotation_vectors(product)
    np.testing.assert_allclose(np.linalg.norm(vectors, axis=1), theirs.magnitude(), atol=1e-6)
    np.testing.assert_allclose(
        Rotation.from_rotvec(vectors).as_matrix(), theirs.as_matrix(), atol=1e-6
    )
    for matrix in theirs.as_matrix():
        np.testing.assert_allclose(matrices(of_matrix(matrix)), matrix, atol=1e-9)
