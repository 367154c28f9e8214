import numpy as np
import pytest
from inhand_tracker.sight.kernels.mark_edges import mark_edges

STEPS = ((0, 1), (1, 1), (1, 0), (1, -1))
"""Rows and columns to the next pixel along each channel's normal."""


def defined(across: np.ndarray, down: np.ndarray, least: float, agreement: float) -> np.ndarray:
    """Edges are no weaker than the pixel ahead, stronger than the one behind, and strong."""
    gradients = np.stack((across, down)).astype(float)
    strengths = np.linalg.norm(gradients, axis=0)
    normals = np.array([(1.0, 0.0), (0.5**0.5, 0.5**0.5), (0.0, 1.0), (0.5**0.5, -(0.5**0.5))])
    along = np.abs(np.einsum("kx,xij->kij", normals, gradients))
    nearest, no_edge = np.argmax(along, axis=0), np.ones(along.shape, np.uint8)
    for row, column in np.argwhere(strengths >= least):
        if not (0 < row < len(across) - 1 and 0 < column < across.shape[1] - 1):
            continue
        step, own = STEPS[nearest[row, column]], strengths[row, column]
        ahead = strengths[row + step[0], column + step[1]]
        if own >= ahead and own > strengths[row - step[0], column - step[1]]:
            no_edge[along[:, row, column] >= agreement * own, row, column] = 0
    return no_edge


@pytest.mark.parametrize("agreement", [0.83, 0.95])
def test_edges_are_those_of_the_definition(agreement: float) -> None:
    across, down = np.random.default_rng(0).normal(0.0, 60.0, (2, 30, 40)).astype(np.int16)
    no_edge = np.ones((4, 30, 40), np.uint8)
    mark_edges(across, down, 50.0, agreement, no_edge)
    assert 50 < (no_edge == 0).sum() < 1200
    np.testing.assert_array_equal(no_edge, defined(across, down, 50.0, agreement))
