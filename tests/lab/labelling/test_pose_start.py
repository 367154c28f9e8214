"""A first pose from points that are clicked on."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from inhand_lab.labelling.equal_poses import Pose
from inhand_lab.labelling.keyframes import LabellingError
from inhand_lab.labelling.measured_depth import point_at
from inhand_lab.labelling.pose_start import (
    PickedPoint,
    pose_at_click,
    pose_from_clicks,
    pose_from_points,
)
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.image import Image
from sights import CAMERA, EXTENTS, PLACE, TURN, WALL_M, box, draw

FRONT = (
    0.5 * np.array(EXTENTS)[:, None] * np.array([[0.7, -0.7, 0.6], [0.6, 0.7, -0.6], [-1.0] * 3])
)
"""Three points on the side of the box that faces the camera, in columns."""


def placed(points: np.ndarray, pose: Pose = (PLACE, TURN)) -> np.ndarray:
    return rotations.rotate(pose[1], points) + pose[0]


def clicks(points: np.ndarray = FRONT.T) -> list[PickedPoint]:
    pixels = CAMERA.project(placed(points))
    return [PickedPoint(pixel, point) for pixel, point in zip(pixels, points, strict=True)]


@settings(max_examples=50, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(3, 6))
def test_any_pose_comes_back_from_any_points_that_are_on_no_line(seed: int, count: int) -> None:
    random = np.random.default_rng(seed)
    points = random.normal(0.0, 0.1, (count, 3))
    points[2] += np.cross(points[0] - points[1], [0.3, 0.5, 0.7])
    pose = random.normal(0.0, 2.0, 3), rotations.from_vector(random.uniform(-2, 2, 3))
    found = pose_from_points(points, placed(points, pose))
    np.testing.assert_allclose(found[0], pose[0], atol=1e-6)
    assert rotations.angle_between(found[1], pose[1]) < 1e-6


def test_three_clicks_on_an_image_give_the_pose() -> None:
    translation, rotation = pose_from_clicks(clicks(), draw())
    assert np.linalg.norm(translation - PLACE) < 0.01
    assert np.rad2deg(rotations.angle_between(rotation, TURN)) < 5.0


def test_depth_of_half_the_size_is_read_at_the_same_place() -> None:
    image = draw()
    assert image.depth is not None
    half = Image(None, CAMERA, image.depth[::2, ::2], image.colour)
    pixel = clicks()[0].pixel
    np.testing.assert_allclose(point_at(half, pixel), point_at(image, pixel), atol=0.005)


@pytest.mark.parametrize("stray", [0.0, np.nan, 0.3, 6.0])
def test_a_stray_depth_at_the_pixel_itself_changes_nothing(stray: float) -> None:
    image, pixel = draw(), clicks()[0].pixel
    expected = point_at(image, pixel)
    assert image.depth is not None
    image.depth[tuple(np.rint(pixel[::-1]).astype(int))] = stray
    np.testing.assert_allclose(point_at(image, pixel), expected, atol=0.003)


def test_where_two_surfaces_meet_and_the_pixel_has_no_depth_the_nearer_one_is_meant() -> None:
    depth = np.full((480, 640), WALL_M, np.float32)
    depth[:, :322], depth[:, 318:324] = 1.0, 0.0
    depth[:, 318] = 1.0
    assert point_at(Image(None, CAMERA, depth), np.array([320.0, 240.0]))[2] == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("points", "line"),
    [
        (FRONT.T[:2], "2 of 3 points"),
        (FRONT.T[[0, 1, 1]], "points 2 and 3 .* in the same place"),
        (np.linspace(FRONT.T[0], FRONT.T[1], 4), "are on one line"),
        (np.vstack((FRONT.T[:2], [[np.nan] * 3])), "not finite"),
    ],
)
def test_points_that_fix_no_pose_are_refused(points: np.ndarray, line: str) -> None:
    with pytest.raises(LabellingError, match=line):
        pose_from_clicks([PickedPoint(np.array([320.0, 240.0]), one) for one in points], draw())


def test_a_pixel_without_depth_or_outside_is_refused() -> None:
    empty = Image(None, CAMERA, np.zeros((480, 640), np.float32))
    with pytest.raises(LabellingError, match="no depth was measured around pixel"):
        pose_from_clicks(clicks(), empty)
    with pytest.raises(LabellingError, match="this frame has no depth"):
        pose_from_clicks(clicks(), Image(None, CAMERA))
    with pytest.raises(LabellingError, match="outside the image"):
        point_at(draw(), np.array([640.0, 10.0]))


def test_points_in_the_wrong_order_are_named() -> None:
    picked = clicks()
    pixels = [one.pixel for one in picked]
    changed = [
        PickedPoint(pixel, one.point)
        for pixel, one in zip((pixels[1], pixels[2], pixels[0]), picked, strict=True)
    ]
    with pytest.raises(LabellingError, match="fit in the order 3, 1, 2"):
        pose_from_clicks(changed, draw())


def test_a_point_that_is_clicked_on_beside_the_object_is_named() -> None:
    picked = clicks()
    picked[2] = PickedPoint(np.array([600.0, 30.0]), picked[2].point)
    with pytest.raises(LabellingError, match="pick that pair again"):
        pose_from_clicks(picked, draw())


def test_one_click_brings_the_middle_there_and_keeps_the_rotation() -> None:
    pixel = CAMERA.project(PLACE[None])[0]
    translation, rotation = pose_at_click(box(), TURN, draw(), pixel)
    np.testing.assert_array_equal(rotation, TURN)
    assert np.linalg.norm(translation - PLACE) < 0.005
