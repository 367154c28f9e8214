"""The vertex error of shifts and turns."""

import numpy as np
import pytest
from inhand_lab.evaluation.vertex_error import vertex_error
from people import quaternion_of
from scipy.spatial.transform import Rotation

IDENTITY = np.array([1.0, 0.0, 0.0, 0.0])


def about_z(degrees: float) -> np.ndarray:
    return quaternion_of(Rotation.from_euler("z", degrees, degrees=True))


def test_a_pure_shift_is_the_vertex_error() -> None:
    vertices = np.random.default_rng(1).normal(size=(6, 3))
    error = vertex_error((np.array([0.03, 0, 0.04]), IDENTITY), (np.zeros(3), IDENTITY), vertices)
    assert error == pytest.approx(0.05)


def test_a_quarter_turn_moves_each_vertex_along_its_chord() -> None:
    # Chords of a quarter turn: radius × √2; a vertex on the axis stays.
    vertices = np.array([[0.1, 0.0, 0.0], [0.0, 0.3, 0.5], [0.0, 0.0, 1.0]])
    error = vertex_error((np.zeros(3), about_z(90)), (np.zeros(3), IDENTITY), vertices)
    assert error == pytest.approx((0.1 + 0.3) * np.sqrt(2) / 3)


def test_vertex_errors_of_a_sequence_are_those_of_its_frames() -> None:
    vertices = np.array([[0.1, 0.0, 0.0], [0.0, 0.2, 0.0]])
    truth = (np.zeros((3, 3)), np.tile(IDENTITY, (3, 1)))
    estimates = (
        np.array([[0, 0, 0], [0, 0, 0.5], [0, 0, 0]]),
        np.array([IDENTITY, IDENTITY, about_z(180)]),
    )
    np.testing.assert_allclose(vertex_error(estimates, truth, vertices), [0, 0.5, 0.3], atol=1e-12)


def test_the_sign_of_a_quaternion_does_not_change_the_vertex_error() -> None:
    vertices = np.array([[0.1, 0.2, 0.3]])
    error = vertex_error((np.zeros(3), -about_z(40)), (np.zeros(3), about_z(40)), vertices)
    assert error == pytest.approx(0.0, abs=1e-12)
