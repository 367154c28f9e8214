import numpy as np
import pytest
from inhand_tracker.shape.raster import nearest_depths


def test_a_triangle_fills_the_pixels_whose_centres_it_holds() -> None:
    pixels = np.array([[1.0, 1.0], [9.0, 1.0], [1.0, 9.0]])
    depths = nearest_depths(pixels, np.array([2.0, 2.0, 2.0]), np.array([[0, 1, 2]]), (12, 12))
    rows, columns = np.mgrid[:12, :12]
    expected = (rows >= 1) & (columns >= 1) & (rows + columns <= 10)
    np.testing.assert_array_equal(np.isfinite(depths), expected)
    assert (depths[expected] == 2.0).all()


def test_depth_is_interpolated_over_a_triangle() -> None:
    pixels = np.array([[0.0, 0.0], [10.0, 0.0], [0.0, 10.0]])
    depths = nearest_depths(pixels, np.array([1.0, 2.0, 5.0]), np.array([[0, 1, 2]]), (12, 12))
    assert depths[0, 5] == pytest.approx(1.5)
    assert depths[5, 0] == pytest.approx(3.0)
    assert depths[2, 3] == pytest.approx(1.0 + 0.3 + 0.8)


@pytest.mark.parametrize("order", [[0, 1], [1, 0]])
def test_the_nearer_surface_hides_the_farther(order: list[int]) -> None:
    corners = np.array([[0.0, 0.0], [8.0, 0.0], [0.0, 8.0]])
    pixels = np.concatenate((corners, corners))
    depths = np.array([3.0] * 3 + [1.0] * 3)
    faces = np.array([[0, 1, 2], [5, 4, 3]])[order]
    buffer = nearest_depths(pixels, depths, faces, (10, 10))
    assert buffer[2, 2] == 1.0


def test_a_triangle_too_thin_for_pixel_centres_is_drawn_as_a_line() -> None:
    pixels = np.array([[2.3, 1.4], [2.4, 1.4], [6.3, 9.4]])
    depths = nearest_depths(pixels, np.array([1.0, 1.0, 3.0]), np.array([[0, 1, 2]]), (12, 12))
    rows, columns = np.nonzero(np.isfinite(depths))
    assert sorted(set(rows.tolist())) == list(range(1, 10))
    np.testing.assert_allclose(columns, 2.35 + (rows - 1.4) / 2, atol=0.9)
    np.testing.assert_allclose(depths[rows, columns], 1.0 + (rows - 1.4) / 4, atol=0.2)


def test_triangles_outside_the_image_draw_nothing() -> None:
    pixels = np.array(
        [[-9.0, -9.0], [-2.0, -9.0], [-9.0, -2.0], [30.0, 30.0], [40.0, 30.0], [30.0, 40.0]]
    )
    depths = nearest_depths(pixels, np.ones(6), np.array([[0, 1, 2], [3, 4, 5]]), (20, 20))
    assert not np.isfinite(depths).any()
