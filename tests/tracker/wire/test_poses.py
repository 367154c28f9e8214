"""Poses and estimates as messages."""

from dataclasses import replace

import numpy as np
import pytest
from inhand_schemas.messages import Box, Pose
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.estimate import LOST, Estimate
from inhand_tracker.wire.poses import (
    SourceFrame,
    compose,
    image_box,
    object_pose_message,
    pose_message,
)
from people import quaternion_of
from scipy.spatial.transform import Rotation


def test_a_transform_becomes_a_message_with_a_unit_quaternion() -> None:
    pose = pose_message(np.array([1.0, 2.0, 3.0]), np.array([0.0, 0.0, 3.0, 4.0]))
    assert pose == Pose((1.0, 2.0, 3.0), (0.0, 0.0, 0.6, 0.8))


def matrix(pose: Pose) -> np.ndarray:
    transform = np.eye(4)
    transform[:3, :3] = Rotation.from_quat(pose.rotation, scalar_first=True).as_matrix()
    transform[:3, 3] = pose.translation
    return transform


def test_composing_is_multiplying_matrices() -> None:
    random = np.random.default_rng(0)
    first, second = (
        pose_message(random.normal(size=3), quaternion_of(Rotation.random(rng=random)))
        for _ in range(2)
    )
    np.testing.assert_allclose(matrix(compose(first, second)), matrix(first) @ matrix(second))


CAMERA = Intrinsics(100.0, 100.0, 50.0, 40.0, 100, 80)
SOURCE = SourceFrame(5, 7, "kitchen")
UNTURNED = np.array([1.0, 0.0, 0.0, 0.0])


def test_an_estimate_becomes_a_message_with_both_frames() -> None:
    turn = Rotation.from_euler("z", 90, degrees=True)
    estimate = Estimate(
        "tracked",
        0.7,
        np.array([1.0, 0, 2]),
        UNTURNED,
        np.arange(36.0).reshape(6, 6),
    )
    rig_from_camera = pose_message(np.array([0.0, 0, 1.5]), quaternion_of(turn))
    box = Box(1.0, 2.0, 3.0, 4.0)
    source = replace(SOURCE, rig_from_camera=rig_from_camera)
    message = object_pose_message(estimate, source, name="mug", person=3, box=box)
    assert (message.sequence, message.time_ns, message.object, message.camera) == (
        5,
        7,
        "mug",
        "kitchen",
    )
    assert (message.state, message.confidence, message.person) == ("tracked", 0.7, 3)
    assert message.camera_from_object == Pose((1.0, 0.0, 2.0), (1.0, 0.0, 0.0, 0.0))
    assert message.rig_from_object is not None
    assert message.rig_from_object.translation == pytest.approx((0.0, 1.0, 3.5))
    assert message.covariance == tuple(float(i) for i in range(36))
    assert message.box == box


def test_a_lost_object_has_no_pose() -> None:
    source = replace(SOURCE, rig_from_camera=Pose((0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0)))
    message = object_pose_message(LOST, source, name="mug", person=3)
    assert message.state == "lost"
    assert message.confidence == 0.0
    assert message.camera_from_object is None
    assert message.rig_from_object is None
    assert message.covariance is None


def test_without_a_rig_there_is_no_pose_in_it() -> None:
    estimate = Estimate("tracked", 1.0, np.zeros(3), UNTURNED, np.zeros((6, 6)))
    message = object_pose_message(estimate, SOURCE, name="mug", person=3)
    assert message.rig_from_object is None
    assert message.camera_from_object is not None


def test_the_box_holds_the_outline() -> None:
    outline = np.array([[10.0, 20.0], [30.0, 25.0], [15.0, 70.0]])
    assert image_box(outline, CAMERA) == Box(10.0, 20.0, 20.0, 50.0)


def test_the_box_is_cut_at_the_image() -> None:
    outline = np.array([[-10.0, 20.0], [130.0, 90.0]])
    assert image_box(outline, CAMERA) == Box(0.0, 20.0, 100.0, 60.0)


@pytest.mark.parametrize(
    "outline",
    [
        None,
        np.array([[-10.0, 5.0], [-1.0, 9.0]]),
        np.array([[101.0, 5.0], [120.0, 9.0]]),
        np.array([[5.0, 81.0], [9.0, 90.0]]),
        np.array([[np.nan, np.nan], [9.0, 9.0]]),
        np.array([[5.0, 5.0], [5.0, 9.0]]),
    ],
)
def test_there_is_no_box_outside_the_image(outline: np.ndarray | None) -> None:
    assert image_box(outline, CAMERA) is None
