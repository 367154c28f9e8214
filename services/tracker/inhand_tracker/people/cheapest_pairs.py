"""Pairs rows with columns at the least cost (the assignment problem)."""

import numpy as np

from inhand_tracker.geometry.arrays import Array


def cheapest_pairs(costs: Array) -> list[tuple[int, int]]:
    """Pair the rows and columns of finite costs (R, C), each with one at the most.

    As many are paired as can be, at the least sum: row by row along the shortest augmenting path
    (Jonker and Volgenant 1987). Returns min(R, C) pairs of row and column.
    """
    if len(costs) > costs.shape[1]:
        return [(row, column) for column, row in cheapest_pairs(costs.T)]
    row_of = np.full(costs.shape[1], -1)
    prices = np.zeros(costs.shape[1])
    for row in range(len(costs)):
        _add_row(row, costs, prices, row_of)
    return [(int(row_of[column]), int(column)) for column in np.flatnonzero(row_of >= 0)]


def _add_row(added: int, costs: Array, prices: Array, row_of: Array) -> None:
    """Pair one more row, moving others to other columns where that is cheaper.

    ``prices`` (C,) are what the columns cost beside ``costs`` (R, C), so that no row would change
    to another; ``row_of`` (C,) has -1 for a column that is free.
    """
    row, so_far, path = added, 0.0, np.full(len(prices), -1)
    distances, done = np.full(len(prices), np.inf), np.zeros(len(prices), np.bool_)
    from_column = -1
    while row >= 0:
        own = 0.0 if from_column < 0 else costs[row, from_column] - prices[from_column]
        reached = so_far + (costs[row] - prices) - own
        nearer = ~done & (reached < distances)
        distances[nearer], path[nearer] = reached[nearer], from_column
        from_column = int(np.argmin(np.where(done, np.inf, distances)))
        so_far, done[from_column] = distances[from_column], True
        row = row_of[from_column]
    prices[done] += distances[done] - so_far
    while from_column >= 0:
        before = path[from_column]
        row_of[from_column] = added if before < 0 else row_of[before]
        from_column = before
