"""A sphere goes where its object's pose goes."""

import numpy as np
import pytest
from inhand_tracker.geometry.bounding_sphere import BoundingSphere
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.pose_gaussian import PoseGaussian
from people import quaternion_of
from scipy.spatial.transform import Rotation

SPHERE = BoundingSphere(np.array([0.1, -0.2, 0.3]), 0.25)
CAMERA = Intrinsics(520.0, 510.0, 320.0, 240.0, 640, 480)
TURNS = Rotation.from_rotvec([[0.4, 1.0, -0.3], [0.0, 0.0, 2.0]])


def test_the_origin_is_an_arm_away_from_the_centre() -> None:
    translations = np.array([[0.0, 1.0, 2.0], [3.0, 0.5, 1.0]])
    centres = translations + TURNS.apply(SPHERE.centre)
    turns = quaternion_of(TURNS)
    np.testing.assert_allclose(SPHERE.origins(centres, turns), translations, atol=1e-12)
    for centre, turn, translation in zip(centres, turns, translations, strict=True):
        np.testing.assert_allclose(centre - SPHERE.arm(turn), translation, atol=1e-12)


def test_poses_of_a_pivot_have_the_same_origin_and_sphere() -> None:
    pivoted = BoundingSphere(SPHERE.centre, SPHERE.radius, np.array([0.0, 0.1, -0.2]))
    translations, turns = np.array([[0.0, 1.0, 2.0], [3.0, 0.5, 1.0]]), quaternion_of(TURNS)
    pivots = translations + TURNS.apply([0.0, 0.1, -0.2])
    middles = translations + TURNS.apply(SPHERE.centre)
    np.testing.assert_allclose(pivoted.origins(pivots, turns), translations, atol=1e-12)
    np.testing.assert_allclose(pivoted.middles(pivots, turns), middles, atol=1e-12)
    poses, of_pivots = (
        [PoseGaussian(place, turn, np.eye(6)) for place, turn in zip(places, turns, strict=True)]
        for places in (middles, pivots)
    )
    assert pivoted.way(*of_pivots, CAMERA) == pytest.approx(SPHERE.way(*poses, CAMERA))


def pose(centre: tuple[float, float, float], turn: Rotation) -> PoseGaussian:
    return PoseGaussian(np.array(centre), quaternion_of(turn), np.eye(6))


def test_its_way_in_the_image_is_the_farthest_that_an_end_of_its_axes_goes() -> None:
    ends = 0.25 * np.vstack((np.eye(3), -np.eye(3)))
    before, after = (
        CAMERA.project(turn.apply(ends) + centre)
        for turn, centre in zip(TURNS, ([0.1, 0.0, 2.0], [0.3, -0.1, 1.5]), strict=True)
    )
    way = SPHERE.way(pose((0.1, 0.0, 2.0), TURNS[0]), pose((0.3, -0.1, 1.5), TURNS[1]), CAMERA)
    assert way == pytest.approx(np.linalg.norm(after - before, axis=1).max())


def test_what_is_behind_the_camera_goes_nowhere_in_the_image() -> None:
    here, behind = pose((0.0, 0.0, 2.0), TURNS[0]), pose((0.0, 0.0, -2.0), TURNS[0])
    assert SPHERE.way(here, behind, CAMERA) == 0.0
    assert SPHERE.way(here, here, CAMERA) == 0.0
