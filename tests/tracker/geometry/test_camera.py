import numpy as np
import pytest
from inhand_schemas.messages import CameraInfo
from inhand_tracker.geometry.camera import Intrinsics, intrinsics_of

CAMERA = Intrinsics(500.0, 400.0, 320.0, 240.0, 640, 480)


def test_points_are_projected_by_hand() -> None:
    pixels = CAMERA.project(np.array([[0.0, 0.0, 1.0], [0.2, -0.1, 2.0], [-1.0, 1.0, 4.0]]))
    np.testing.assert_allclose(pixels, [[320, 240], [370, 220], [195, 340]])


def test_points_behind_the_camera_or_at_the_lens_have_no_pixel() -> None:
    points = np.array([[0.1, 0.1, -1.0], [0.1, 0.1, 0.0], [0.0, 0.0, 0.01], [np.nan, 0.0, 1.0]])
    pixels = CAMERA.project(points)
    assert np.isnan(pixels[:3]).all()
    assert np.isnan(pixels[3]).any()
    assert np.isfinite(CAMERA.project(np.array([[0.0, 0.0, 0.06]]))).all()


def test_the_shape_of_the_points_is_kept() -> None:
    assert CAMERA.project(np.ones((2, 5, 3))).shape == (2, 5, 2)


def test_a_smaller_image_shows_the_same_view() -> None:
    points = np.random.default_rng(0).uniform([-1, -1, 1], [1, 1, 3], (20, 3))
    large, small = CAMERA.project(points), CAMERA.scaled_to(320, 160).project(points)
    # Pixel centres are whole numbers: the image spans -0.5 to width - 0.5.
    np.testing.assert_allclose((small + 0.5) * [2.0, 3.0], large + 0.5)
    assert CAMERA.scaled_to(640, 480) == CAMERA


def test_intrinsics_come_from_the_camera_info() -> None:
    info = CameraInfo(sequence=0, time_ns=0, width=8, height=6, fx=1.5, fy=2.5, cx=3.5, cy=4.5)
    assert intrinsics_of(info) == Intrinsics(1.5, 2.5, 3.5, 4.5, 8, 6)


def test_a_camera_is_square_on_to_its_axis() -> None:
    centre = CAMERA.project(np.array([0.0, 0.0, 3.0]))
    assert centre.tolist() == pytest.approx([320.0, 240.0])
