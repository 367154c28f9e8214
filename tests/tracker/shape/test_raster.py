import numpy as np
import pytest
from inhand_tracker.shape.raster import nearest_depths
from scipy.spatial.distance import cdist


def brute_force(
    pixels: np.ndarray, depths: np.ndarray, faces: np.ndarray, size: int
) -> tuple[np.ndarray, np.ndarray]:
    """Depths by solving for barycentric coordinates, and how deep inside a triangle pixels lie."""
    buffer = np.full((size, size), np.inf)
    margin = np.full((size, size), -np.inf)
    for face in faces:
        corners = np.vstack((pixels[face].T, np.ones(3)))
        if abs(np.linalg.det(corners)) < 1e-9:
            continue
        for y in range(size):
            for x in range(size):
                shares = np.linalg.solve(corners, [x, y, 1.0])
                margin[y, x] = max(margin[y, x], shares.min())
                if shares.min() >= 0:
                    buffer[y, x] = min(buffer[y, x], shares @ depths[face])
    return buffer, margin


def test_a_triangle_fills_the_pixels_whose_centres_it_holds() -> None:
    pixels = np.array([[1.0, 1.0], [9.0, 1.0], [1.0, 9.0]])
    depths = nearest_depths(pixels, np.array([2.0, 2.0, 2.0]), np.array([[0, 1, 2]]), 12)
    rows, columns = np.mgrid[:12, :12]
    expected = (rows >= 1) & (columns >= 1) & (rows + columns <= 10)
    np.testing.assert_array_equal(np.isfinite(depths), expected)
    assert (depths[expected] == 2.0).all()


def test_depth_is_interpolated_over_a_triangle() -> None:
    pixels = np.array([[0.0, 0.0], [10.0, 0.0], [0.0, 10.0]])
    depths = nearest_depths(pixels, np.array([1.0, 2.0, 5.0]), np.array([[0, 1, 2]]), 12)
    assert depths[0, 5] == pytest.approx(1.5)
    assert depths[5, 0] == pytest.approx(3.0)
    assert depths[2, 3] == pytest.approx(1.0 + 0.3 + 0.8)


@pytest.mark.parametrize("order", [[0, 1], [1, 0]])
def test_the_nearer_surface_hides_the_farther(order: list[int]) -> None:
    corners = np.array([[0.0, 0.0], [8.0, 0.0], [0.0, 8.0]])
    pixels = np.concatenate((corners, corners))
    depths = np.array([3.0] * 3 + [1.0] * 3)
    faces = np.array([[0, 1, 2], [5, 4, 3]])[order]
    buffer = nearest_depths(pixels, depths, faces, 10)
    assert buffer[2, 2] == 1.0


@pytest.mark.parametrize("seed", range(3))
def test_any_triangles_agree_with_barycentric_coordinates(seed: int) -> None:
    random = np.random.default_rng(seed)
    pixels = random.uniform(-5, 25, (12, 2))
    depths = random.uniform(1, 2, 12)
    faces = random.integers(0, 12, (6, 3))
    expected, margin = brute_force(pixels, depths, faces, 20)
    buffer = nearest_depths(pixels, depths, faces, 20)
    assert np.isfinite(buffer[margin > 1e-9]).all()
    filled = np.isfinite(expected)
    assert (buffer[filled] <= expected[filled] + 1e-9).all()
    # The lines around faces add no more than their own pixels.
    alone = np.isfinite(buffer) & ~filled
    assert (cdist(np.argwhere(alone), on_edges(pixels, faces)).min(axis=1) < 0.75).all()


def on_edges(pixels: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Points (row, column) close together on every edge."""
    shares = np.linspace(0.0, 1.0, 200)[:, None]
    ends = [(pixels[face[i]], pixels[face[i - 1]]) for face in faces for i in range(3)]
    return np.concatenate([(1 - shares) * a + shares * b for a, b in ends])[:, ::-1]


def test_a_triangle_too_thin_for_pixel_centres_is_drawn_as_a_line() -> None:
    pixels = np.array([[2.3, 1.4], [2.4, 1.4], [6.3, 9.4]])
    depths = nearest_depths(pixels, np.array([1.0, 1.0, 3.0]), np.array([[0, 1, 2]]), 12)
    rows, columns = np.nonzero(np.isfinite(depths))
    assert sorted(set(rows.tolist())) == list(range(1, 10))
    np.testing.assert_allclose(columns, 2.35 + (rows - 1.4) / 2, atol=0.9)
    np.testing.assert_allclose(depths[rows, columns], 1.0 + (rows - 1.4) / 4, atol=0.2)


def test_triangles_outside_the_image_draw_nothing() -> None:
    pixels = np.array(
        [[-9.0, -9.0], [-2.0, -9.0], [-9.0, -2.0], [30.0, 30.0], [40.0, 30.0], [30.0, 40.0]]
    )
    depths = nearest_depths(pixels, np.ones(6), np.array([[0, 1, 2], [3, 4, 5]]), 20)
    assert not np.isfinite(depths).any()
