"""A camera that hangs on its side or upside down."""

import math
from typing import Any

import msgspec
import numpy as np
import pytest
from inhand_capture.view.turning import Turn
from inhand_runtime.source import SourceError
from inhand_schemas.messages import Box, CameraInfo, ObjectPose, Person, Pose

WIDTH, HEIGHT = 64, 48
INFO = CameraInfo(
    sequence=0, time_ns=0, width=WIDTH, height=HEIGHT, fx=50, fy=55, cx=30, cy=20,
    distortion=(0.1, 0.02, 0.003, -0.004, 0.05),
    rig_from_camera=Pose((1.0, 2.0, 3.0), (0.5, 0.5, 0.5, 0.5)),
)  # fmt: skip
POINTS = ((0.1, 0.2, 2.0), (-0.4, 0.3, 1.5), (0.0, -0.1, 1.0))
TURNS = pytest.mark.parametrize("quarters", [0, 1, 2, 3])


def _seen(info: CameraInfo, point: tuple[float, float, float]) -> tuple[float, float]:
    """Project by OpenCV's model."""
    x, y = point[0] / point[2], point[1] / point[2]
    k1, k2, p1, p2, k3 = info.distortion
    r2 = x * x + y * y
    radial = 1 + k1 * r2 + k2 * r2**2 + k3 * r2**3
    return (
        info.fx * (x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)) + info.cx,
        info.fy * (y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y) + info.cy,
    )


def _rotated(rotation: tuple[float, ...], point: Any) -> Any:
    w, v = rotation[0], np.array(rotation[1:])
    return point + 2 * np.cross(v, np.cross(v, point) + w * np.asarray(point))


def _pixel(quarters: int, u: float, v: float) -> tuple[float, float]:
    """Where a pixel goes, by turning the picture."""
    height, width = HEIGHT, WIDTH
    for _ in range(quarters):
        u, v = height - 1 - v, u
        height, width = width, height
    return u, v


@TURNS
def test_what_a_pixel_shows_goes_where_the_turned_lens_sees_it(quarters: int) -> None:
    turn = Turn(quarters, WIDTH, HEIGHT)
    info = turn.info(INFO)
    for point in POINTS:
        expected = _pixel(quarters, *_seen(INFO, point))
        assert _seen(info, turn.point(point)) == pytest.approx(expected)


@TURNS
def test_pictures_turn_clockwise(quarters: int) -> None:
    turn = Turn(quarters, WIDTH, HEIGHT)
    picture = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
    picture[5, 10] = 7
    turned = turn.picture(picture)
    column, row = _pixel(quarters, 10, 5)
    assert turned.shape[:2] == (turn.info(INFO).height, turn.info(INFO).width)
    assert turned[int(row), int(column), 0] == 7
    assert turned.flags.c_contiguous
    np.testing.assert_array_equal(turn.back(turned[..., 0]), picture[..., 0])


@TURNS
def test_a_point_of_the_rig_stays_where_it_is(quarters: int) -> None:
    turn = Turn(quarters, WIDTH, HEIGHT)
    for point in POINTS:
        in_rig = [
            np.array(info.rig_from_camera.translation)
            + _rotated(info.rig_from_camera.rotation, np.array(seen))
            for info, seen in ((INFO, point), (turn.info(INFO), turn.point(point)))
        ]
        np.testing.assert_allclose(in_rig[0], in_rig[1], atol=1e-12)


@TURNS
def test_a_label_is_what_the_turned_camera_sees(quarters: int) -> None:
    turn = Turn(quarters, WIDTH, HEIGHT)
    pose = Pose((0.1, 0.2, 2.0), (0.8, 0.0, 0.6, 0.0))
    covariance = np.diag([1.0, 2, 3, 4, 5, 6])
    covariance[0, 1] = covariance[1, 0] = 0.5
    label = ObjectPose(
        sequence=0, time_ns=0, object="mug", camera="x", state="tracked", confidence=1,
        camera_from_object=pose, box=Box(10, 5, 20, 8), person_joints=POINTS[:1] * 20,
        covariance=tuple(covariance.ravel().tolist()),
    )  # fmt: skip
    turned = turn.label(label)
    assert turned.camera_from_object is not None
    corner = np.array((0.03, -0.02, 0.05))
    before = np.array(pose.translation) + _rotated(pose.rotation, corner)
    after = turned.camera_from_object
    seen = np.array(after.translation) + _rotated(after.rotation, corner)
    np.testing.assert_allclose(seen, turn.point(tuple(before.tolist())), atol=1e-12)
    assert turned.box is not None
    corners = sorted((_pixel(quarters, 10, 5), _pixel(quarters, 30, 13)))
    assert (turned.box.left, turned.box.top) == (
        min(u for u, _ in corners),
        min(v for _, v in corners),
    )
    assert turned.box.width * turned.box.height == 160
    assert turned.person_joints == (turn.point(POINTS[0]),) * 20
    assert turned.covariance is not None
    values = np.linalg.eigvalsh(np.reshape(turned.covariance, (6, 6)))
    np.testing.assert_allclose(values, np.linalg.eigvalsh(covariance))
    axis = np.array(turn.point((0.0, 1.0, 0.0)))
    assert axis @ np.reshape(turned.covariance, (6, 6))[:3, :3] @ axis == pytest.approx(2.0)


def test_a_skeleton_turns_joint_by_joint() -> None:
    person = Person(id=1, joints=POINTS[:1] * 20, states=("tracked",) * 20, confidences=(1,) * 20)
    assert Turn(2, WIDTH, HEIGHT).person(person).joints == ((-0.1, -0.2, 2.0),) * 20


def test_a_tilted_sensor_cannot_be_turned() -> None:
    tilted = msgspec.structs.replace(INFO, distortion=(0.0,) * 12 + (0.01, 0.0))
    with pytest.raises(SourceError, match="undistort its pictures first"):
        Turn(1, WIDTH, HEIGHT).info(tilted)
    assert Turn(0, WIDTH, HEIGHT).info(tilted) == tilted


def test_thin_prism_coefficients_turn_too() -> None:
    prism = msgspec.structs.replace(INFO, distortion=(0.0,) * 8 + (1.0, 2.0, 3.0, 4.0))
    assert Turn(1, WIDTH, HEIGHT).info(prism).distortion[8:] == (-3.0, -4.0, 1.0, 2.0)
    assert math.isclose(Turn(1, WIDTH, HEIGHT).info(prism).fx, INFO.fy)
