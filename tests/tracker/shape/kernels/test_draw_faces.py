import numpy as np
import pytest
from inhand_tracker.shape.kernels.draw_faces import draw_faces
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


@pytest.mark.parametrize("seed", range(3))
def test_any_triangles_agree_with_barycentric_coordinates(seed: int) -> None:
    random = np.random.default_rng(seed)
    pixels = random.uniform(-5, 25, (12, 2))
    depths = random.uniform(1, 2, 12)
    faces = random.integers(0, 12, (6, 3))
    expected, margin = brute_force(pixels, depths, faces, 20)
    buffer, owners = np.full((20, 20), np.inf), np.full((20, 20), -1)
    draw_faces(pixels, depths, faces, buffer, owners)
    np.testing.assert_array_equal(owners >= 0, np.isfinite(buffer))
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


def test_each_pixel_belongs_to_the_face_that_is_nearest_there() -> None:
    corners = np.array([[1.0, 1.0], [8.0, 1.0], [1.0, 8.0]])
    pixels, depths = np.concatenate((corners, corners + 2.0)), np.repeat([2.0, 1.0], 3)
    buffer, owners = np.full((12, 12), np.inf), np.full((12, 12), -1)
    draw_faces(pixels, depths, np.array([[0, 1, 2], [3, 4, 5]]), buffer, owners)
    expected = np.select([np.isclose(buffer, 1.0), np.isclose(buffer, 2.0)], [1, 0], -1)
    np.testing.assert_array_equal(owners, expected)
    assert owners[4, 4] == 1
    assert owners[1, 1] == 0
