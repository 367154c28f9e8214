"""Depth aligned to another view is the depth that rays of that view meet."""

import numpy as np
import pytest
from inhand_runtime.errors import InhandError
from inhand_schemas.messages import CameraInfo
from inhand_tracker.geometry.rotations import from_vector, to_matrix

from inhand.imports.alignment import DepthAlignment, align_depth, project, unproject

SHIFT_M = np.array([-0.032, -0.002, 0.004])
TURN = to_matrix(from_vector(np.array([-0.06, 0.003, 0.01])))
WALL_M, BOARD_M = 2.0, 0.8
KINECT = (-1.06, -1.4, 0.0007, -0.00001, 1.75, -1.15, -1.19, 1.62)
"""Distortion of a real Azure Kinect's colour camera, in OpenCV's order."""


def camera(width: int, height: int, focal: float, distortion: tuple[float, ...]) -> CameraInfo:
    centre = (width - 1) / 2.0 + 3.0, (height - 1) / 2.0 - 2.0
    lens = {"fx": focal, "fy": focal, "cx": centre[0], "cy": centre[1]}
    return CameraInfo(
        sequence=0, time_ns=0, width=width, height=height, distortion=distortion, **lens
    )


DEPTH = camera(160, 144, 126.0, (0.58, 0.006, 0.0, 0.0, -0.001, 0.92, 0.12, -0.006))
VIEW = camera(320, 180, 150.0, KINECT)


def grid(shown: CameraInfo) -> np.ndarray:
    x, y = np.meshgrid(np.arange(shown.width), np.arange(shown.height))
    return np.stack((x, y), axis=-1).reshape(-1, 2).astype(float)


def cast(origin: np.ndarray, rays: np.ndarray) -> np.ndarray:
    """Distances along rays from a point of the depth camera's frame to the first surface: a wall at
    z = 2 m, slanted, and before it a board at z = 0.8 m that is 20 cm wide and high."""
    wall = np.array([0.3, 0.1, 1.0])
    to_wall = (WALL_M - origin @ wall) / (rays @ wall)
    to_board = (BOARD_M - origin[2]) / rays[:, 2]
    met = origin + to_board[:, None] * rays
    on_board = np.abs(met[:, :2]).max(axis=1) < 0.1
    return np.where(on_board, to_board, to_wall)


@pytest.fixture(scope="module")
def alignment() -> DepthAlignment:
    return align_depth(DEPTH, VIEW, TURN, SHIFT_M)


def test_aligned_depth_is_what_rays_of_the_other_view_meet(alignment: DepthAlignment) -> None:
    ahead = np.column_stack((unproject(grid(DEPTH), DEPTH), np.ones(160 * 144)))
    seen = np.round(1000.0 * cast(np.zeros(3), ahead)).astype(np.uint16).reshape(144, 160)
    aligned = alignment(seen).astype(int)
    rays = np.column_stack((unproject(grid(VIEW), VIEW), np.ones(320 * 180)))
    # A ray of the view in the depth camera's frame: x = R' (d r - t); its z in the view is d.
    true = 1000.0 * cast(-TURN.T @ SHIFT_M, rays @ TURN).reshape(180, 320)
    inside = slice(30, 150), slice(60, 260)
    off = np.abs(aligned - true)[inside]
    assert np.count_nonzero(aligned[inside]) > 0.985 * off.size  # the board's shadow has no depth
    surface = aligned[inside] > 0
    # A pixel of depth is 16 mm wide or more on the wall, which falls by a third of that.
    assert np.quantile(off[surface], 0.98) < 8.0
    assert np.median(off[surface & (true[inside] < 1000.0)]) <= 1.0


def test_a_lens_is_inverted_to_a_thousandth_of_a_pixel(alignment: DepthAlignment) -> None:
    for shown in (DEPTH, VIEW):
        rays = unproject(grid(shown), shown)
        assert np.isfinite(rays).all()
        back = project(np.column_stack((rays, np.ones(len(rays)))), shown)
        np.testing.assert_allclose(back, grid(shown), atol=1e-3)


def test_nothing_measured_is_nothing_seen_and_another_size_is_refused(
    alignment: DepthAlignment,
) -> None:
    assert not alignment(np.zeros((144, 160), np.uint16)).any()
    assert alignment(np.full((144, 160), 65535, np.uint16)).max() <= 65534
    with pytest.raises(InhandError, match="depth is 320 × 288, and its calibration is of 160"):
        alignment(np.zeros((288, 320), np.uint16))


def test_the_same_view_is_the_same_depth() -> None:
    plain = camera(64, 48, 60.0, ())
    depth = np.random.default_rng(5).integers(100, 5000, (48, 64)).astype(np.uint16)
    depth[10:20, 10:20] = 0
    align = align_depth(plain, plain, np.eye(3), np.zeros(3))
    np.testing.assert_array_equal(align(depth), depth)
