"""Joints and images out of messages."""

import numpy as np
import pytest
from inhand_runtime.pixels import encode_colour, encode_depth
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import CameraInfo, DepthImage, Person, RgbdFrame
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.methods.darby2014.depths import surfaces_of
from inhand_tracker.wire.conversion import image_of, joints_of
from people import person


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


def test_a_skeleton_that_is_all_zero_is_of_nobody() -> None:
    zeros = Person(
        id=1, joints=((0.0, 0.0, 0.0),) * 20, states=("tracked",) * 20, confidences=(1.0,) * 20
    )
    assert np.isnan(joints_of(zeros)).all()


VIEW = {"width": 64, "height": 48, "fx": 50.0, "fy": 50.0, "cx": 31.5, "cy": 23.5}
INFO = CameraInfo(sequence=0, time_ns=0, depth_scale=0.0005, **VIEW)
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
