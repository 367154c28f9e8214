"""How a pose is moved and turned by hand."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from inhand_studio.labelling_page.placing import (
    composed,
    dragged,
    from_degrees,
    inverse,
    moved,
    to_degrees,
    turned,
)
from inhand_tracker.geometry import rotations

vectors = st.tuples(*[st.floats(-2.0, 2.0)] * 3).map(np.array)
turns = vectors.map(rotations.from_vector)
poses = st.tuples(vectors, turns)


def _same(one: tuple[np.ndarray, np.ndarray], other: tuple[np.ndarray, np.ndarray]) -> bool:
    apart = np.linalg.norm(one[0] - other[0])
    return bool(apart < 1e-6 and rotations.angle_between(one[1], other[1]) < 1e-6)


@given(rotation=turns)
def test_degrees_make_the_rotation_that_they_are_of(rotation: np.ndarray) -> None:
    assert rotations.angle_between(from_degrees(to_degrees(rotation)), rotation) < 1e-6


@pytest.mark.parametrize("about_y", [90.0, -90.0])
def test_degrees_make_the_rotation_where_two_axes_are_one(about_y: float) -> None:
    rotation = from_degrees(np.array([30.0, about_y, 50.0]))
    assert rotations.angle_between(from_degrees(to_degrees(rotation)), rotation) < 1e-6


def test_degrees_turn_about_x_then_y_then_z_of_the_camera() -> None:
    rotation = from_degrees(np.array([90.0, 90.0, 0.0]))
    assert rotations.rotate(rotation, np.array([0.0, 1.0, 0.0])) == pytest.approx([1.0, 0.0, 0.0])


@given(pose=poses, step=vectors, axes=turns)
def test_a_step_goes_along_the_axes_and_keeps_the_rotation(
    pose: tuple[np.ndarray, np.ndarray], step: np.ndarray, axes: np.ndarray
) -> None:
    place, rotation = moved(pose, step, axes)
    assert rotations.rotate(rotations.conjugate(axes), place - pose[0]) == pytest.approx(step)
    assert rotation is pose[1]


@given(pose=poses, turn=vectors, axes=turns, point=vectors)
def test_a_turn_leaves_the_point_that_it_is_about_and_is_undone_by_the_same_back(
    pose: tuple[np.ndarray, np.ndarray], turn: np.ndarray, axes: np.ndarray, point: np.ndarray
) -> None:
    about = pose[0] + rotations.rotate(pose[1], point)
    there = turned(pose, turn, axes, about)
    assert there[0] + rotations.rotate(there[1], point) == pytest.approx(about)
    assert _same(turned(there, -turn, axes, about), pose)


@given(pose=poses, before=poses, after=poses)
def test_what_is_dragged_keeps_its_pose_in_the_handles(
    pose: tuple[np.ndarray, np.ndarray],
    before: tuple[np.ndarray, np.ndarray],
    after: tuple[np.ndarray, np.ndarray],
) -> None:
    there = dragged(pose, before, after)
    assert _same(composed(inverse(after), there), composed(inverse(before), pose))
