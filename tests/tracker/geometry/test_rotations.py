import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given
from hypothesis.extra.numpy import arrays
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.kernels.nearest_rotation import nearest_rotation
from people import quaternion_of, same_rotation, scipy_rotation
from scipy.spatial.transform import Rotation

components = st.floats(-1.0, 1.0, allow_nan=False, width=64)


def units(count: int) -> st.SearchStrategy[np.ndarray]:
    return (
        arrays(float, (count, 4), elements=components)
        .filter(lambda q: bool((np.linalg.norm(q, axis=1) > 0.1).all()))
        .map(lambda q: q / np.linalg.norm(q, axis=1, keepdims=True))
    )


vectors = arrays(float, 3, elements=st.floats(-10, 10))


@given(units(2))
def test_multiplying_applies_the_second_rotation_first(q: np.ndarray) -> None:
    expected = (scipy_rotation(q[0]) * scipy_rotation(q[1])).as_matrix()
    product = rotations.multiply(q[0], q[1])
    np.testing.assert_allclose(scipy_rotation(product).as_matrix(), expected, atol=1e-12)


@given(units(1), vectors)
def test_rotating_vectors_agrees_with_scipy(q: np.ndarray, vector: np.ndarray) -> None:
    expected = scipy_rotation(q[0]).apply(vector)
    np.testing.assert_allclose(rotations.rotate(q[0], vector), expected, atol=1e-12)


@given(units(1))
def test_matrices_agree_with_scipy(q: np.ndarray) -> None:
    expected = scipy_rotation(q[0]).as_matrix()
    np.testing.assert_allclose(rotations.to_matrix(q[0]), expected, atol=1e-12)


@given(units(1), vectors)
def test_the_conjugate_undoes_a_rotation(q: np.ndarray, vector: np.ndarray) -> None:
    there = rotations.rotate(q[0], vector)
    np.testing.assert_allclose(
        rotations.rotate(rotations.conjugate(q[0]), there), vector, atol=1e-9
    )


@given(units(3))
def test_quaternions_are_recovered_from_matrices(q: np.ndarray) -> None:
    assert same_rotation(rotations.from_matrix(scipy_rotation(q).as_matrix()), q)


@pytest.mark.parametrize("axis", np.eye(3))
@pytest.mark.parametrize("angle", [np.pi, np.pi - 1e-9, np.pi + 1e-9, 1e-12, 0.0])
def test_half_turns_and_tiny_turns_survive_the_matrix(axis: np.ndarray, angle: float) -> None:
    rotation = Rotation.from_rotvec(angle * axis)
    assert same_rotation(rotations.from_matrix(rotation.as_matrix()), quaternion_of(rotation))


@given(arrays(float, 3, elements=st.floats(-1.8, 1.8)))
def test_rotation_vectors_there_and_back_agree_with_scipy(vector: np.ndarray) -> None:
    quaternion = rotations.from_vector(vector)
    assert same_rotation(quaternion, quaternion_of(Rotation.from_rotvec(vector)))
    np.testing.assert_allclose(rotations.to_vector(quaternion), vector, atol=1e-9)


@given(units(1))
def test_rotation_vectors_are_the_short_way_round(q: np.ndarray) -> None:
    expected = scipy_rotation(q[0]).magnitude()
    for signed in (q[0], -q[0]):
        assert np.linalg.norm(rotations.to_vector(signed)) == pytest.approx(expected, abs=1e-7)


def test_tiny_rotation_vectors_keep_their_digits() -> None:
    vector = np.array([3e-10, -4e-10, 0.0])
    np.testing.assert_allclose(
        rotations.to_vector(rotations.from_vector(vector)), vector, rtol=1e-9
    )
    np.testing.assert_array_equal(rotations.to_vector(np.array([1.0, 0, 0, 0])), np.zeros(3))


@given(units(2))
def test_separation_is_half_of_the_angle_between_rotations(q: np.ndarray) -> None:
    between = (scipy_rotation(q[0]) * scipy_rotation(q[1]).inv()).magnitude()
    assert rotations.separation(q[0], q[1]) == pytest.approx(between / 2, abs=1e-6)
    assert rotations.separation(-q[0], q[1]) == pytest.approx(between / 2, abs=1e-6)
    assert rotations.angle_between(q[0], q[1]) == pytest.approx(between, abs=1e-6)


def test_a_quarter_turn_is_separated_by_an_eighth_of_a_circle() -> None:
    quarter = np.array([np.cos(np.pi / 4), 0.0, np.sin(np.pi / 4), 0.0])
    assert rotations.separation(quarter, np.array([1.0, 0, 0, 0])) == pytest.approx(np.pi / 4)


@given(units(1))
def test_separation_from_itself_is_a_number(q: np.ndarray) -> None:
    assert 0.0 <= rotations.separation(q[0], q[0]) < 1e-7


def principal_by_power_iteration(quaternions: np.ndarray, weights: np.ndarray) -> np.ndarray:
    matrix = sum(w * np.outer(q, q) for q, w in zip(quaternions, weights, strict=True))
    vector = quaternions[np.argmax(weights)]
    for _ in range(200):
        vector = matrix @ vector
        vector /= np.linalg.norm(vector)
    return vector


def test_the_mean_is_the_eigenvector_of_the_largest_eigenvalue() -> None:
    random = np.random.default_rng(3)
    centre = Rotation.from_rotvec([0.4, -1.2, 0.3])
    quaternions = quaternion_of(centre * Rotation.from_rotvec(0.6 * random.normal(size=(12, 3))))
    weights = random.random(12)
    expected = principal_by_power_iteration(quaternions, weights)
    assert same_rotation(rotations.mean(quaternions, weights), expected)


def test_the_mean_agrees_with_scipy_and_is_a_unit_quaternion() -> None:
    random = np.random.default_rng(4)
    many = Rotation.from_rotvec(0.5 * random.normal(size=(30, 3)))
    weights = random.random(30)
    mean = rotations.mean(quaternion_of(many), weights)
    assert np.linalg.norm(mean) == pytest.approx(1.0)
    assert same_rotation(mean, quaternion_of(many.mean(weights)))


@given(st.lists(st.booleans(), min_size=9, max_size=9))
def test_the_mean_does_not_depend_on_signs(flips: list[bool]) -> None:
    random = np.random.default_rng(5)
    quaternions = quaternion_of(Rotation.from_rotvec(random.normal(size=(9, 3))))
    weights = random.random(9)
    signs = np.where(flips, -1.0, 1.0)[:, None]
    expected = rotations.mean(quaternions, weights)
    assert same_rotation(rotations.mean(quaternions * signs, weights), expected)


def test_the_mean_of_two_turns_about_one_axis_lies_between_them() -> None:
    turns = np.array([rotations.from_vector(np.array([0, 0, a])) for a in (0.2, 1.0)])
    assert same_rotation(
        rotations.mean(turns, np.ones(2)), np.array([np.cos(0.3), 0.0, 0.0, np.sin(0.3)])
    )


def test_weights_of_zero_leave_rotations_out_of_the_mean() -> None:
    turns = quaternion_of(Rotation.from_rotvec([[0.1, 0, 0], [0, 2.0, 0]]))
    assert same_rotation(rotations.mean(turns, np.array([1.0, 0.0])), turns[0])


def test_means_are_taken_over_the_last_axis_but_one() -> None:
    random = np.random.default_rng(6)
    stacks = quaternion_of(Rotation.from_rotvec(0.3 * random.normal(size=(15, 3)))).reshape(3, 5, 4)
    weights = random.random((3, 5))
    means = rotations.mean(stacks, weights)
    for stack, weight, mean in zip(stacks, weights, means, strict=True):
        assert same_rotation(mean, principal_by_power_iteration(stack, weight))


def test_opposite_rotations_still_have_a_finite_mean() -> None:
    opposite = np.array([[1.0, 0, 0, 0], [0, 1.0, 0, 0]])
    mean = rotations.mean(opposite, np.ones(2))
    assert np.linalg.norm(mean) == pytest.approx(1.0)


@given(st.integers(0, 200))
def test_no_rotation_is_nearer_than_the_nearest(seed: int) -> None:
    random = np.random.default_rng(seed)
    matrix = random.normal(size=(3, 3))
    found = np.empty((3, 3))
    nearest_rotation(matrix, found)
    assert np.linalg.det(found) == pytest.approx(1.0)
    others = Rotation.random(200, random_state=seed).as_matrix()
    distances = np.linalg.norm(others - matrix, axis=(1, 2))
    assert np.linalg.norm(found - matrix) <= distances.min() + 1e-9


def test_what_is_missing_stays_missing_without_a_word() -> None:
    """Warnings are errors here. Many at once, as a compiler looks at several together."""
    rotation, vector = np.full((64, 4), np.nan), np.full((64, 3), np.nan)
    rotation[::3], vector[::3] = [1.0, 0.0, 0.0, 0.0], 0.0
    for found in (
        rotations.to_vector(rotation),
        rotations.from_vector(vector),
        rotations.rotate(rotation, vector),
        rotations.multiply(rotation, rotation),
        rotations.from_matrix(rotations.to_matrix(rotation)),
        rotations.principal(rotation[:, :, None] * rotation[:, None]),
    ):
        np.testing.assert_array_equal(np.isfinite(found).all(axis=1), np.arange(64) % 3 == 0)
    nearest = np.empty((3, 3))
    nearest_rotation(np.full((3, 3), np.nan), nearest)
    assert np.isnan(nearest).all()
