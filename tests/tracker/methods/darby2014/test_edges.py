import numpy as np
import pytest
from hypothesis import given
from hypothesis.extra.numpy import arrays
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.methods.darby2014.edges import chamfer_image, edge_log_weights

CHAMFER = np.array([[0.0, 0.25, 0.5], [1.0, 0.75, 0.0]], np.float32)  # 3 wide, 2 high


def square(size: int = 100) -> np.ndarray:
    grey = np.zeros((size, size), np.uint8)
    grey[30:70, 20:80] = 200
    return grey


def test_the_chamfer_image_is_one_at_an_edge_and_zero_far_away() -> None:
    chamfer = chamfer_image(square())
    assert chamfer.shape == (100, 100)
    assert chamfer.max() == pytest.approx(1.0)
    assert chamfer[50, 18:22].max() > 0.75
    assert chamfer[29:31, 50].min() > 0.75
    assert chamfer[50, 50] == pytest.approx(0.0, abs=1e-6)
    assert chamfer[5, 5] == pytest.approx(0.0, abs=1e-6)


def test_nearness_falls_with_the_distance_from_an_edge() -> None:
    row = chamfer_image(square())[50, 20:40]
    assert (np.diff(row[:8]) < 0).all()
    assert row[0] == pytest.approx(chamfer_image(square())[50, 19], rel=1e-5)


def test_edges_of_both_directions_count_alike() -> None:
    grey = np.zeros((90, 90), np.uint8)
    grey[:, 45:] = 255
    np.testing.assert_allclose(chamfer_image(grey), chamfer_image(grey.T.copy()).T, atol=1e-6)


@pytest.mark.parametrize("grey", [0, 128, 255])
def test_an_empty_image_has_no_edges(grey: int) -> None:
    chamfer = chamfer_image(np.full((40, 50), grey, np.uint8))
    np.testing.assert_array_equal(chamfer, np.zeros((40, 50)))


def test_faint_gradients_are_no_edges() -> None:
    ramp = np.tile(np.arange(100, dtype=np.uint8), (50, 1))
    assert chamfer_image(ramp).max() == 0.0


@given(arrays(np.uint8, (12, 17)))
def test_nearness_lies_between_zero_and_one(grey: np.ndarray) -> None:
    chamfer = chamfer_image(grey)
    assert chamfer.min() >= 0.0
    assert chamfer.max() <= 1.0


def test_sigma_is_the_mean_of_squared_distances_from_one() -> None:
    pixels = np.array([[[0, 1], [1, 1]], [[2, 0], [1, 0]]], float)
    # (0, 1): r = 1 and 0.75; (2, 0): r = 0.5 and 0.25.
    expected = [-(0.0 + 0.0625) / 2, -(0.25 + 0.5625) / 2]
    np.testing.assert_allclose(edge_log_weights(CHAMFER, pixels), expected)


def test_pixels_are_rounded_to_the_nearest() -> None:
    pixels = np.array([[[0.4, 0.6]], [[-0.4, 1.4]], [[0.6, 0.6]]])
    np.testing.assert_allclose(edge_log_weights(CHAMFER, pixels), [0.0, 0.0, -0.0625])


@pytest.mark.parametrize(
    "outside",
    [
        (-0.6, 1.0),
        (-1.0, -1.0),
        (3.0, 1.0),
        (2.51, 1.0),
        (0.0, 2.0),
        (0.0, -1.0),
        (1e300, 0.0),
        (-1e300, 1.0),
        (np.nan, np.nan),
        (0.0, np.nan),
        (np.inf, 1.0),
        (0.0, -np.inf),
    ],
)
def test_points_outside_the_image_or_behind_the_camera_count_as_far_from_edges(
    outside: tuple[float, float],
) -> None:
    everywhere = np.ones((2, 3), np.float32)
    pixels = np.array([[outside, (0.0, 1.0), (1.0, 1.0), (2.0, 0.0)]])
    assert edge_log_weights(everywhere, pixels) == pytest.approx(-0.25)


def test_a_hypothesis_wholly_behind_the_camera_weighs_least() -> None:
    camera = Intrinsics(2.0, 2.0, 1.0, 0.5, 3, 2)
    points = np.array([[[0.0, 0.0, 1.0]] * 4, [[0.0, 0.0, -1.0]] * 4])
    log_weights = edge_log_weights(np.full((2, 3), 0.5, np.float32), camera.project(points))
    np.testing.assert_allclose(log_weights, [-0.25, -1.0])


def test_every_point_counts_the_same_in_both_axes() -> None:
    random = np.random.default_rng(3)
    chamfer = random.random((30, 40)).astype(np.float32)
    pixels = random.uniform(-5, 45, (6, 50, 2))
    expected = []
    for hypothesis in pixels:
        total = 0.0
        for x, y in hypothesis:
            column, row = round(x), round(y)
            inside = 0 <= column < 40 and 0 <= row < 30
            total += (1.0 - (float(chamfer[row, column]) if inside else 0.0)) ** 2
        expected.append(-total / 50)
    np.testing.assert_allclose(edge_log_weights(chamfer, pixels), expected, rtol=1e-6)
