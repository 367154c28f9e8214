import numpy as np
import pytest
from inhand_runtime.pixels import encode_colour, encode_depth
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import Box, CameraInfo, DepthImage, Person, Pose, RgbdFrame
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.estimate import LOST, Estimate
from inhand_tracker.methods.darby2014.depths import surfaces_of
from inhand_tracker.wire.conversion import (
    box_around,
    image_of,
    joints_of,
    object_pose_message,
)
from inhand_tracker.wire.poses import compose, pose_message
from people import person, quaternion_of
from scipy.spatial.transform import Rotation

CAMERA = Intrinsics(100.0, 100.0, 50.0, 40.0, 100, 80)


def test_missing_joints_are_not_a_number() -> None:
    joints = joints_of(person(1, missing=(0, 7)))
    assert joints.shape == (20, 3)
    assert np.flatnonzero(np.isnan(joints).all(axis=1)).tolist() == [0, 7]
    assert np.isfinite(np.delete(joints, [0, 7], axis=0)).all()
    np.testing.assert_allclose(joints[3], [0.3, -0.3, 2.0])


@pytest.mark.parametrize("wild", [1e5, -1e20, 1e200, 1e308])
def test_joints_beyond_any_room_are_missing(wild: float) -> None:
    joints = joints_of(person(1, wild=wild))
    assert np.flatnonzero(np.isnan(joints).all(axis=1)).tolist() == [11]


def test_inferred_joints_are_used() -> None:
    guessed = Person(
        id=1,
        joints=((0.0, 0.0, 1.0),) * 20,
        states=("inferred",) * 20,
        confidences=(0.5,) * 20,
    )
    assert np.isfinite(joints_of(guessed)).all()


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


SOURCE = {"sequence": 5, "time_ns": 7, "name": "mug", "camera": "kitchen", "person": 3}


def test_an_estimate_becomes_a_message_with_both_frames() -> None:
    turn = Rotation.from_euler("z", 90, degrees=True)
    estimate = Estimate(
        "tracked",
        0.7,
        np.array([1.0, 0, 2]),
        np.array([1.0, 0, 0, 0]),
        np.arange(36.0).reshape(6, 6),
    )
    rig_from_camera = pose_message(np.array([0.0, 0, 1.5]), quaternion_of(turn))
    box = Box(1.0, 2.0, 3.0, 4.0)
    message = object_pose_message(estimate, **SOURCE, rig_from_camera=rig_from_camera, box=box)
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
    message = object_pose_message(
        LOST, **SOURCE, rig_from_camera=Pose((0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0)), box=None
    )
    assert message.state == "lost"
    assert message.confidence == 0.0
    assert message.camera_from_object is None
    assert message.rig_from_object is None
    assert message.covariance is None


def test_without_a_rig_there_is_no_pose_in_it() -> None:
    estimate = Estimate("tracked", 1.0, np.zeros(3), np.array([1.0, 0, 0, 0]), np.zeros((6, 6)))
    message = object_pose_message(estimate, **SOURCE, rig_from_camera=None, box=None)
    assert message.rig_from_object is None
    assert message.camera_from_object is not None


def test_the_box_holds_the_outline() -> None:
    outline = np.array([[10.0, 20.0], [30.0, 25.0], [15.0, 70.0]])
    assert box_around(outline, CAMERA) == Box(10.0, 20.0, 20.0, 50.0)


def test_the_box_is_cut_at_the_image() -> None:
    outline = np.array([[-10.0, 20.0], [130.0, 90.0]])
    assert box_around(outline, CAMERA) == Box(0.0, 20.0, 100.0, 60.0)


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
    assert box_around(outline, CAMERA) is None


INFO = CameraInfo(
    sequence=0,
    time_ns=0,
    width=64,
    height=48,
    fx=50.0,
    fy=50.0,
    cx=31.5,
    cy=23.5,
    depth_scale=0.0005,
)
COLOUR = encode_colour(np.full((48, 64, 3), 90, np.uint8))
DEPTH = encode_depth(np.full((24, 32), 3000, np.uint16))
FRAME = RgbdFrame(sequence=0, time_ns=0, colour=COLOUR, depth=DEPTH)


def test_only_what_the_terms_need_is_decoded() -> None:
    damaged = RgbdFrame(
        sequence=0, time_ns=0, colour=COLOUR, depth=DepthImage("z16-zstd", 32, 24, b"")
    )
    image = image_of(damaged, INFO, ("edges",))
    assert image is not None
    assert image.depth is None
    with pytest.raises(MessageError, match="damaged depth"):
        image_of(damaged, INFO, ("edges", "depth"))


def test_depth_becomes_metres_in_the_camera_s_view() -> None:
    image = image_of(FRAME, INFO, ("depth",))
    assert image is not None
    assert image.grey is None
    np.testing.assert_allclose(image.depth, np.full((24, 32), 1.5))
    # The wall of 1.5 m in the smaller image is where the camera's own pixels say.
    (near,) = image.once(surfaces_of).distances(np.array([[[0.3, 0.2, 1.5]]]))
    assert near[0] < 0.05


def test_colours_are_decoded_when_asked_for_and_depth_beside_them() -> None:
    image = image_of(FRAME, INFO, ("colour", "depth"))
    assert image is not None
    assert image.grey is None
    assert image.colour is not None
    assert image.colour.shape == (48, 64, 3)
    np.testing.assert_allclose(image.colour, 90, atol=2)
    assert image.depth is not None
    assert image.camera.width == 64


def test_luminance_keeps_the_size_of_the_colour_image() -> None:
    small = RgbdFrame(
        sequence=0, time_ns=0, colour=encode_colour(np.full((24, 32, 3), 90, np.uint8))
    )
    image = image_of(small, INFO, ("edges", "depth"))
    assert image is not None
    assert image.grey.shape == (24, 32)
    assert image.camera == Intrinsics(25.0, 25.0, 15.5, 11.5, 32, 24)


@pytest.mark.parametrize(
    ("frame", "terms"),
    [
        (FRAME, ()),
        (RgbdFrame(sequence=0, time_ns=0, depth=DEPTH), ("edges",)),
        (RgbdFrame(sequence=0, time_ns=0, colour=COLOUR), ("depth",)),
        (RgbdFrame(sequence=0, time_ns=0), ("edges", "depth")),
    ],
)
def test_a_frame_without_what_the_terms_need_is_no_image(
    frame: RgbdFrame, terms: tuple[str, ...]
) -> None:
    assert image_of(frame, INFO, terms) is None
