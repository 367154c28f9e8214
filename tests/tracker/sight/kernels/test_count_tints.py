import numpy as np
import pytest
from inhand_tracker.sight.kernels.count_tints import count_tints

LOGS = np.log((np.arange(1021) + 2.0) / 4.0)
CELLS, WIDEST, STEP, LEVELS = 6, 0.8, 5, (20, 240)
NEAR = 1.5, 0.3


def defined(colour: np.ndarray, depth: np.ndarray) -> np.ndarray:
    sums = np.zeros((CELLS, CELLS, 3))
    height, width = colour.shape[:2]
    for row in range(0, height - 1, STEP):
        for column in range(0, width - 1, STEP):
            mean = colour[row : row + 2, column : column + 2].reshape(4, 3).mean(axis=0)
            apart = True
            if depth.size:
                rows, columns = depth.shape
                metres = depth[row * rows // height, column * columns // width]
                apart = metres > 0.0 and abs(metres - NEAR[0]) > NEAR[1]
            if apart and LEVELS[0] <= mean.min() and mean.max() <= LEVELS[1]:
                logs = np.log(mean + 0.5)
                tints = np.clip((logs - logs[1])[::2], -WIDEST, WIDEST)
                place = np.minimum((tints + WIDEST) / (2 * WIDEST) * CELLS, CELLS - 1).astype(int)
                sums[tuple(place)] += 1.0, mean.mean(), 0.5 * (tints[0] - tints[1])
    return sums


@pytest.mark.parametrize("size", [(0, 0), (31, 43), (15, 20)])
def test_samples_are_those_of_the_definition(size: tuple[int, int]) -> None:
    random = np.random.default_rng(6)
    colour = random.integers(0, 256, (31, 43, 3)).astype(np.uint8)
    depth = random.choice([0.0, 1.4, 1.7, 2.5, 0.9], size).astype(np.float32)
    sums = np.zeros((CELLS, CELLS, 3))
    added = count_tints(colour, depth, NEAR, STEP, LEVELS, LOGS, WIDEST, sums)
    expected = defined(colour, depth)
    assert added == expected[..., 0].sum() > 5
    np.testing.assert_allclose(sums, expected, atol=1e-9)
