import numpy as np
import pytest
import trimesh
from inhand_tracker.shape.kernels.nearest_view import nearest_views
from inhand_tracker.shape.view_grid import view_grid


def sphere(subdivisions: int) -> np.ndarray:
    vertices = np.asarray(trimesh.creation.icosphere(subdivisions).vertices, float)
    return vertices / np.linalg.norm(vertices, axis=1, keepdims=True)


@pytest.mark.parametrize("directions", [sphere(2), sphere(3), np.eye(3), sphere(1)[:5]])
def test_the_nearest_direction_is_found_exactly(directions: np.ndarray) -> None:
    random = np.random.default_rng(0)
    vectors = random.normal(size=(5000, 3)) * random.uniform(0.1, 10.0, (5000, 1))
    # Also along the edges and corners of the cube, where cells meet.
    vectors[:200] = random.choice([-1.0, 0.0, 1.0], (200, 3)) + 1e-9
    agreement = vectors @ directions.T
    found = nearest_views(view_grid(directions), np.ascontiguousarray(directions), vectors)
    chosen = agreement[np.arange(len(vectors)), found]
    np.testing.assert_allclose(chosen, agreement.max(axis=1), atol=1e-6)


def test_no_direction_at_all_gives_one_of_them() -> None:
    directions = sphere(2)
    (found,) = nearest_views(view_grid(directions), directions, np.zeros((1, 3)))
    assert 0 <= found < len(directions)
