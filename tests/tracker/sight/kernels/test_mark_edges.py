import numpy as np
import pytest
from inhand_tracker.sight.kernels.mark_edges import find_distances, mark_edges

STEPS = ((0, 1), (1, 1), (1, 0), (1, -1))
"""Rows and columns to the next pixel along each channel's normal."""


def defined(across: np.ndarray, down: np.ndarray, least: float, agreement: float) -> np.ndarray:
    """Edges are strong, and no weaker than the pixels ahead and behind."""
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
        if own >= ahead and own >= strengths[row - step[0], column - step[1]]:
            no_edge[along[:, row, column] >= agreement * own, row, column] = 0
    return no_edge


def bits(no_edge: np.ndarray) -> np.ndarray:
    """A bit for each channel (4, H, W) that has an edge, with a rim of a pixel."""
    return np.pad(((1 - no_edge) << np.arange(4)[:, None, None]).sum(axis=0), 1).astype(np.uint8)


@pytest.mark.parametrize("agreement", [0.83, 0.95])
def test_edges_are_those_of_the_definition(agreement: float) -> None:
    across, down = np.random.default_rng(0).normal(0.0, 60.0, (2, 30, 40)).astype(np.int16)
    edges = np.zeros((32, 42), np.uint8)
    mark_edges(across, down, 50.0, agreement, edges)
    assert 50 < (edges > 0).sum() < 1200
    np.testing.assert_array_equal(edges, bits(defined(across, down, 50.0, agreement)))


def test_distances_are_those_to_the_next_edge_in_octagons() -> None:
    """By their definition: a step grows to four neighbours, the next one to eight, and so on."""
    no_edge = (np.random.default_rng(1).random((4, 25, 33)) > 0.01).astype(np.uint8)
    rows, columns = np.mgrid[-24:25, -32:33]
    steps = np.maximum(np.maximum(abs(rows), abs(columns)), -(-2 * (abs(rows) + abs(columns)) // 3))
    expected = np.full(no_edge.shape, 7)
    for channel, row, column in np.argwhere(no_edge == 0):
        away = steps[24 - row : 49 - row, 32 - column : 65 - column]
        expected[channel] = np.minimum(expected[channel], away)
    distances = np.empty(no_edge.shape, np.uint8)
    find_distances(bits(no_edge), 7, distances)
    np.testing.assert_array_equal(distances, expected)
