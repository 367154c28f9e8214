"""Pairs are as cheap as those of SciPy."""

import numpy as np
import pytest
from inhand_tracker.people.cheapest_pairs import cheapest_pairs
from scipy.optimize import linear_sum_assignment


@pytest.mark.parametrize("shape", [(1, 1), (1, 6), (6, 1), (3, 5), (5, 3), (7, 7)])
def test_as_many_as_can_be_are_paired_at_the_least_sum(shape: tuple[int, int]) -> None:
    random = np.random.default_rng(0)
    for _ in range(50):
        costs = random.normal(size=shape)
        costs[random.random(shape) < 0.3] = 1e6
        rows, columns = zip(*cheapest_pairs(costs), strict=True)
        assert len(set(rows)) == len(set(columns)) == min(shape)
        best = costs[linear_sum_assignment(costs)].sum()
        assert costs[list(rows), list(columns)].sum() == pytest.approx(best, abs=1e-9, rel=1e-12)
