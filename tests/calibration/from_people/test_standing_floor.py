"""The floor from feet, and the rig's frame on it."""

import numpy as np
import pytest
from inhand_calibration.floor import Floor
from inhand_calibration.from_people.calibration import calibrate_from_people
from inhand_calibration.from_people.rig_frame import floor_frame
from inhand_schemas.joints import Joint
from wanderers import FRONT, LEFT, transform_of, true_movement, watch, with_joints


def test_the_rig_stands_on_the_floor_below_the_reference() -> None:
    walk = true_movement(1)
    found = calibrate_from_people([watch(FRONT, walk), watch(LEFT, walk)], "front")
    pose = transform_of(found.cameras["front"].rig_from_camera)
    np.testing.assert_allclose(pose.translation, [0.0, 0.0, FRONT.height], atol=0.03)
    rig_from_world = pose @ FRONT.world_from_camera.inverse()
    assert np.degrees(np.arccos(rig_from_world.rotation[2, 2])) < 1.0
    looks = pose.rotation[:, 2]
    assert looks[0] > 0.9
    assert looks[1] == pytest.approx(0.0, abs=1e-9)
    assert found.floor is not None
    assert found.floor.tilt_deviation < np.radians(1.5)


def test_the_origin_is_below_a_point_that_is_given() -> None:
    walk = true_movement(1)
    point = FRONT.world_from_camera.inverse().apply([0.3, -0.2, 0.7])
    cameras = [watch(FRONT, walk), watch(LEFT, walk)]
    found = calibrate_from_people(cameras, "front", origin=point)
    pose = transform_of(found.cameras["front"].rig_from_camera)
    assert pose.apply(point)[:2] == pytest.approx([0.0, 0.0], abs=1e-9)
    assert pose.apply(point)[2] == pytest.approx(0.7, abs=0.03)
    assert found.frame.endswith("origin on the floor below the point that was given")


def test_without_feet_the_frame_is_the_reference_cameras() -> None:
    walk = true_movement(1)
    cameras = []
    for camera in (FRONT, LEFT):
        seen = watch(camera, walk)
        joints = seen.joints.copy()
        joints[:, [Joint.ANKLE_LEFT, Joint.ANKLE_RIGHT, Joint.FOOT_LEFT, Joint.FOOT_RIGHT]] = np.nan
        cameras.append(with_joints(seen, joints))
    found = calibrate_from_people(cameras, "front")
    assert found.floor is None
    assert found.cameras["front"].rig_from_camera.translation == (0.0, 0.0, 0.0)
    assert "no feet were seen" in found.warnings[0]


def test_x_follows_the_image_of_a_camera_that_looks_down() -> None:
    floor = Floor(np.array([0.0, 0.0, -1.0]), -2.4, 0.01, 0.01)
    rig = floor_frame(floor)
    np.testing.assert_allclose(rig.rotation @ [0.0, -1.0, 0.0], [1.0, 0.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(rig.apply(np.zeros(3)), [0.0, 0.0, 2.4], atol=1e-12)
