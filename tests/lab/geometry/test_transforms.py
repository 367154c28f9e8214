"""Rigid transforms and rotation matrices."""

import numpy as np
import pytest
from inhand_lab.geometry.transforms import (
    Transform,
    interpolate,
    mean_rotation,
    quaternions,
    rotation_about,
    rotation_from_axes,
    rotation_from_vector,
    turn_points,
)
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array

COUNT = 60
RANDOM = np.random.default_rng(0)
VECTORS = RANDOM.normal(size=(COUNT, 3))
POINTS = RANDOM.normal(size=(COUNT, 3))
SERIES = Transform(RANDOM.normal(size=(COUNT, 3)), rotation_from_vector(VECTORS))


def steadily_turning(angle: float) -> Array:
    """Rotations (COUNT, 3, 3) about an oblique axis, by as much from each to the next."""
    axis = np.array([1.0, 2.0, -2.0]) / 3.0
    return rotation_from_vector(np.outer(angle * np.arange(COUNT), axis))


def test_a_transform_and_its_inverse_cancel() -> None:
    back = SERIES.inverse() @ SERIES
    assert np.allclose(back.translation, 0.0)
    assert np.allclose(back.rotation, np.eye(3))
    assert np.allclose(SERIES.inverse().apply(SERIES.apply(POINTS)), POINTS)


def test_a_mirrored_transform_maps_mirrored_points() -> None:
    mirror = np.array([-1.0, 1.0, 1.0])
    assert np.allclose(SERIES.mirrored().apply(POINTS * mirror), SERIES.apply(POINTS) * mirror)


def test_euler_angles_turn_about_the_named_axes_in_their_order() -> None:
    about_z = rotation_about("z", 0.5 * np.pi)
    assert about_z @ [1.0, 0.0, 0.0] == pytest.approx([0.0, 1.0, 0.0], abs=1e-12)
    both = rotation_about("zx", 0.3, np.linspace(0.0, 1.0, 5))
    assert np.allclose(both[3], rotation_about("x", 0.75) @ rotation_about("z", 0.3))


def test_axes_are_right_handed_and_lean_where_they_should() -> None:
    made = rotation_from_axes(VECTORS, POINTS)
    assert np.allclose(np.linalg.det(made), 1.0)
    assert np.allclose(np.cross(made[:, :, 1], VECTORS), 0.0)
    assert (np.sum(made[:, :, 2] * POINTS, axis=1) > 0.0).all()


def test_half_the_way_is_as_far_from_both_ends() -> None:
    other = SERIES[::-1]
    middle = interpolate(SERIES, other, np.full(COUNT, 0.5))
    assert np.allclose(middle.translation, 0.5 * (SERIES.translation + other.translation))
    ways = [np.swapaxes(end.rotation, 1, 2) @ middle.rotation for end in (SERIES, other)]
    traces = [np.trace(way, axis1=1, axis2=2) for way in ways]
    assert np.allclose(*traces)


def test_points_are_turned_as_by_matrices() -> None:
    expected = np.einsum("tij,tj->ti", SERIES.rotation, POINTS)
    assert np.allclose(turn_points(POINTS, VECTORS), expected)


def test_the_mean_of_a_steady_turn_is_its_middle() -> None:
    turning = steadily_turning(0.01)
    middle = mean_rotation(turning[:-1])
    assert np.allclose(middle, turning[(COUNT - 1) // 2], atol=1e-6)


def test_quaternions_are_the_trackers_and_never_change_their_sign() -> None:
    turning = steadily_turning(0.4)
    made = quaternions(turning)
    assert np.sum(made[1:] * made[:-1], axis=1).min() > 0.9
    assert made[0, 0] > 0.0
    expected = rotations.from_matrix(turning)
    signs = np.sign(np.sum(made * expected, axis=1))[:, None]
    assert np.abs(made - signs * expected).max() < 1e-12
