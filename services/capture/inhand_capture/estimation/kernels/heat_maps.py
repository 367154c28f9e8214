"""Landmarks drawn to the middle of what their heat maps show about them."""

import numpy as np
from inhand_runtime.compiled import njit


@njit(cache=True, nogil=True)
def refine(places, heat, reach, least):  # type: ignore[no-untyped-def]
    """Return places (N, 2), in pixels of a crop, moved to the mean of their heat maps' windows.

    ``heat`` (S, S, N) are logits, four pixels a cell; a window reaches so many cells from the place
    to each side. A place whose window holds no score of ``least`` stays where it is.
    """
    side = heat.shape[0]
    refined = places.copy()
    for point in range(len(places)):
        column, row = int(places[point, 0] / 4.0), int(places[point, 1] / 4.0)
        if not (0 <= column < side and 0 <= row < side):
            continue
        weight = across = down = most = 0.0
        for y in range(max(row - reach, 0), min(row + reach + 1, side)):
            for x in range(max(column - reach, 0), min(column + reach + 1, side)):
                score = 1.0 / (1.0 + np.exp(-heat[y, x, point]))
                weight += score
                across += score * x
                down += score * y
                most = max(most, score)
        if most >= least:
            refined[point, 0] = 4.0 * across / weight
            refined[point, 1] = 4.0 * down / weight
    return refined
