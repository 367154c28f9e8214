"""Poses that look the same."""

import numpy as np
import pytest
from inhand_lab.labelling.equal_poses import nearest_equal, turned
from inhand_tracker.geometry import rotations
from inhand_tracker.shape.shape import Symmetry

LAST = np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0])
CENTRE = (0.1, 0.0, 0.05)


def about(axis: tuple[float, float, float], degrees: float) -> np.ndarray:
    return rotations.from_vector(np.deg2rad(degrees) * np.array(axis))


@pytest.mark.parametrize(
    ("order", "degrees", "left"),
    [(0, 137.0, 0.0), (0, -20.0, 0.0), (2, 170.0, -10.0), (4, 100.0, 10.0), (4, 40.0, 40.0)],
)
def test_of_equal_poses_the_one_that_is_turned_least_is_taken(
    order: int, degrees: float, left: float
) -> None:
    symmetry = Symmetry((0.0, 0.0, 2.0), CENTRE, order)
    _, turn = nearest_equal((np.ones(3), about((0, 0, 1), degrees)), LAST, (symmetry,))
    assert np.rad2deg(rotations.angle_between(turn, about((0, 0, 1), left))) < 1e-5


def test_an_equal_pose_leaves_the_axis_where_it_is() -> None:
    symmetry = Symmetry((0.0, 1.0, 0.0), CENTRE, 0)
    pose = np.array([0.3, -0.2, 2.0]), about((0.6, 0.0, 0.8), 50.0)
    equal = nearest_equal(pose, LAST, (symmetry,))
    for point in (np.array(CENTRE), np.add(CENTRE, (0.0, 0.4, 0.0))):
        places = [rotations.rotate(turn, point) + place for place, turn in (pose, equal)]
        np.testing.assert_allclose(places[0], places[1], atol=1e-12)


def test_no_turn_about_a_continuous_axis_is_nearer() -> None:
    symmetry = Symmetry((0.0, 1.0, 0.0), CENTRE, 0)
    pose = np.zeros(3), about((0.6, 0.0, 0.8), 75.0)
    _, nearest = nearest_equal(pose, LAST, (symmetry,))
    others = [turned(pose, symmetry, angle)[1] for angle in np.linspace(0.0, 2.0 * np.pi, 400)]
    least = min(float(rotations.angle_between(LAST[1], one)) for one in others)
    assert float(rotations.angle_between(LAST[1], nearest)) <= least + 1e-9


def test_without_symmetries_a_pose_is_only_equal_to_itself() -> None:
    pose = np.ones(3), about((0, 0, 1), 170.0)
    assert nearest_equal(pose, LAST, ()) is pose
