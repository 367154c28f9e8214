import numpy as np
import trimesh
from inhand_tracker.shape.view_grid import view_grid


def test_a_cell_has_few_candidates() -> None:
    directions = np.asarray(trimesh.creation.icosphere(3).vertices, float)
    grid = view_grid(directions / np.linalg.norm(directions, axis=1, keepdims=True))
    assert grid.shape[-1] <= 6
    assert (grid[..., 0] >= 0).all()
