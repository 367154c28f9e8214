"""Where cameras stand."""

import numpy as np
import pytest
from inhand_lab.motions.furniture import Cuboid
from inhand_lab.people.person import sample_person
from inhand_lab.sensing.cameras import KINECT
from inhand_lab.world.parameters import CAMERA_PLACINGS, USUAL_VIEWS
from inhand_lab.world.viewpoint import facing_of, hidden, looking, place_camera


def test_a_camera_looks_at_its_target_and_stands_upright() -> None:
    position, target = np.array([1.0, 2.0, 1.2]), np.array([0.0, 0.1, 0.8])
    camera_from_world = looking(position, target)
    seen = camera_from_world.apply(target)
    assert seen == pytest.approx([0.0, 0.0, np.linalg.norm(target - position)])
    up = camera_from_world.rotation @ [0.0, 0.0, 1.0]
    assert up[0] == pytest.approx(0.0)
    assert up[1] < 0.0


def test_the_direction_to_a_camera_is_found_from_its_place() -> None:
    for number in range(5):
        random = np.random.default_rng(number)
        facing, camera_from_world = place_camera(sample_person(1, 0), KINECT.intrinsics, random)
        assert abs(facing) <= CAMERA_PLACINGS[USUAL_VIEWS].aside
        assert facing_of(camera_from_world) == pytest.approx(facing)


def directions(views: str) -> list[float]:
    person = sample_person(1, 0)
    return [
        abs(place_camera(person, KINECT.intrinsics, np.random.default_rng(number), views=views)[0])
        for number in range(200)
    ]


def test_cameras_stand_before_people_or_where_a_dataset_asks_for_it_anywhere_round_them() -> None:
    before, around = directions(USUAL_VIEWS), directions("around")
    assert max(before) <= CAMERA_PLACINGS[USUAL_VIEWS].aside < np.radians(45.0)
    assert max(around) > np.radians(170.0)
    assert np.radians(80.0) < np.median(around) < np.radians(100.0)


def test_a_camera_does_not_stand_behind_furniture() -> None:
    person = sample_person(1, 0)
    board = Cuboid((0.7, 0.1, 1.0), (0.03, 0.8, 2.0), (200, 200, 200))
    assert hidden(person, np.array([2.5, 0.0, 1.2]), (board,))
    assert not hidden(person, np.array([-2.5, 0.0, 1.2]), (board,))
    for number in range(60):
        random = np.random.default_rng(number)
        _, camera_from_world = place_camera(person, KINECT.intrinsics, random, (board,), "around")
        assert not hidden(person, camera_from_world.inverse().translation, (board,))
