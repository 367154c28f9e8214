"""Refined landmarks against their definition."""

import numpy as np
from inhand_capture.estimation.kernels.heat_maps import refine


def test_a_landmark_goes_to_the_mean_of_its_window_where_that_is_sure() -> None:
    random = np.random.default_rng(3)
    heat = random.normal(-1.0, 2.0, (64, 64, 5)).astype(np.float32)
    places = np.array([[100.0, 80.0], [2.0, 255.0], [-9.0, 40.0], [300.0, 20.0], [128.0, 9.0]])
    heat[..., 4] = -9.0
    refined = refine(places, heat, 3, 0.5)
    scores = 1.0 / (1.0 + np.exp(-heat.astype(float)))
    for point in (0, 1):
        column, row = (places[point] / 4.0).astype(int)
        rows, columns = np.mgrid[max(row - 3, 0) : row + 4, max(column - 3, 0) : column + 4]
        inside = (rows < 64) & (columns < 64)
        rows, columns = rows[inside], columns[inside]
        weights = scores[rows, columns, point]
        mean = [4.0 * (weights * axis).sum() / weights.sum() for axis in (columns, rows)]
        np.testing.assert_allclose(refined[point], mean)
    np.testing.assert_array_equal(refined[2:], places[2:])
