"""Where cameras stand."""

import numpy as np
import pytest
from inhand_lab.motions.furniture import Cuboid
from inhand_lab.people.person import sample_person
from inhand_lab.sensing.cameras import KINECT
from inhand_lab.world.parameters import ALIKE_CAMERA_PLACING
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
        assert facing_of(camera_from_world) == pytest.approx(facing)


def directions(variety: float) -> list[float]:
    person = sample_person(1, 0, variety)
    return [
        abs(place_camera(person, KINECT.intrinsics, np.random.default_rng(number))[0])
        for number in range(200)
    ]


def test_cameras_stand_all_around_but_mostly_before_people_and_without_variety_only_there() -> None:
    varied, alike = directions(1.0), directions(0.0)
    assert max(varied) > np.radians(150.0)
    assert np.median(varied) < np.radians(60.0)
    assert max(alike) <= ALIKE_CAMERA_PLACING.aside


def test_a_camera_does_not_stand_behind_furniture() -> None:
    person = sample_person(1, 0)
    board = Cuboid((0.7, 0.1, 1.0), (0.03, 0.8, 2.0), (200, 200, 200))
    assert hidden(person, np.array([2.5, 0.0, 1.2]), (board,))
    assert not hidden(person, np.array([-2.5, 0.0, 1.2]), (board,))
    for number in range(60):
        random = np.random.default_rng(number)
        _, camera_from_world = place_camera(person, KINECT.intrinsics, random, (board,))
        assert not hidden(person, camera_from_world.inverse().translation, (board,))
