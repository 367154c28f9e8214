"""The browser's camera sees what the rig's camera sees, where it is."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from inhand_studio.eye import Eye, eye_towards, whole_eye
from inhand_tracker.geometry.camera import Intrinsics

CAMERA = Intrinsics(525.0, 515.0, 300.0, 250.0, 640, 480)
COLUMNS, ROWS = np.meshgrid(np.arange(640.0), np.arange(480.0))

# All are seen, and so is a dot about them.
targets = st.tuples(st.floats(-0.35, 0.35), st.floats(-0.3, 0.3), st.floats(0.9, 4.0)).map(np.array)
aspects = st.floats(0.5, 2.5)


def _pixel_in(eye: Eye, point: np.ndarray) -> np.ndarray:
    return eye.lens.project(eye.camera_from_eye.T @ point)


def _dot_at(point: np.ndarray) -> np.ndarray:
    """Draw a blurred dot where the camera sees a point."""
    x, y = CAMERA.project(point)
    grey = 255.0 * np.exp(-((COLUMNS - x) ** 2 + (ROWS - y) ** 2) / 72.0)
    return np.repeat(grey[..., None], 3, axis=2).astype(np.uint8)


def _middle_of(image: np.ndarray) -> np.ndarray:
    grey = image[..., 0].astype(float)
    rows, columns = np.indices(grey.shape)
    return np.array([(grey * columns).sum(), (grey * rows).sum()]) / grey.sum()


@given(point=targets, aspect=aspects)
def test_the_eye_sees_a_point_where_its_lens_projects_it(point: np.ndarray, aspect: float) -> None:
    for eye in (whole_eye(CAMERA, aspect, 300), eye_towards(point, 0.3, aspect, 300)):
        seen = eye.see(_dot_at(point), CAMERA)
        assert _middle_of(seen) == pytest.approx(_pixel_in(eye, point), abs=0.5)


@given(aspect=aspects)
def test_a_whole_eye_sees_every_corner_of_the_image(aspect: float) -> None:
    lens = whole_eye(CAMERA, aspect, 300).lens
    corners = np.array([[-0.5, -0.5], [639.5, -0.5], [-0.5, 479.5], [639.5, 479.5]])
    seen = lens.project(CAMERA.unproject(corners, np.ones(4)))
    assert (seen >= -0.51).all()
    assert (seen <= np.array([lens.width, lens.height]) - 0.49).all()


@given(target=targets, reach=st.floats(0.05, 0.5))
def test_an_eye_towards_a_point_has_it_in_its_middle_and_does_not_roll(
    target: np.ndarray, reach: float
) -> None:
    eye = eye_towards(target, reach, 1.5, 300)
    assert _pixel_in(eye, target) == pytest.approx([eye.lens.cx, eye.lens.cy])
    assert eye.camera_from_eye[1, 0] == pytest.approx(0.0)
    above = target - reach * eye.camera_from_eye[:, 1]
    assert _pixel_in(eye, above)[1] == pytest.approx(-0.5)


@given(target=targets)
def test_depth_seen_by_an_eye_is_that_of_the_same_surface(target: np.ndarray) -> None:
    eye = eye_towards(target, 0.4, 1.0, 100)
    wall = np.full((480, 640), 2.0, np.float32)
    seen = eye.see_depth(wall, CAMERA)
    rows, columns = np.nonzero(seen)
    points = eye.lens.unproject(np.column_stack((columns, rows)).astype(float), seen[rows, columns])
    assert (points @ eye.camera_from_eye.T)[:, 2] == pytest.approx(2.0, abs=1e-4)
