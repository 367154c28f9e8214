"""Where cameras stand."""

import numpy as np
import pytest
from inhand_lab.people.person import sample_person
from inhand_lab.sensing.cameras import KINECT
from inhand_lab.world.parameters import DEFAULT_CAMERA_PLACING
from inhand_lab.world.viewpoint import facing_of, looking, place_camera


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
        assert abs(facing) <= DEFAULT_CAMERA_PLACING.aside
        assert facing_of(camera_from_world) == pytest.approx(facing)
