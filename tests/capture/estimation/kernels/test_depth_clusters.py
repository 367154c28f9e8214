"""Surfaces about a pixel against their definition."""

import numpy as np
from inhand_capture.estimation.kernels.depth_clusters import (
    clusters,
    surfaces_about,
    window_depths,
)


def test_a_window_is_a_disc_of_what_was_measured() -> None:
    random = np.random.default_rng(1)
    depth = random.integers(0, 4000, (30, 40)).astype(np.uint16)
    depth[random.random(depth.shape) < 0.3] = 0
    for x, y, reach in ((20.2, 14.7, 4.0), (0.0, 29.0, 5.0), (39.4, 3.0, 2.5), (-30.0, 5.0, 4.0)):
        v, u = np.mgrid[:30, :40]
        near = (v - round(y)) ** 2 + (u - round(x)) ** 2 <= reach**2 + 0.5
        near &= (abs(v - round(y)) <= int(reach)) & (abs(u - round(x)) <= int(reach))
        expected = np.sort(0.001 * depth[near & (depth > 0)])
        np.testing.assert_allclose(window_depths(depth, 0.001, x, y, reach), expected)


def test_depths_apart_are_of_several_surfaces_the_largest_first() -> None:
    ordered = np.array([1.0, 1.01, 1.02, 2.0, 3.0, 3.01, 3.02, 3.03, 5.0, 5.01])
    middles, shares = clusters(ordered, 0.02, 2, 4)
    np.testing.assert_allclose(middles, [3.015, 1.01, 5.005])
    np.testing.assert_allclose(shares, [0.4, 0.3, 0.2])
    assert len(clusters(ordered, 0.02, 2, 1)[0]) == 1
    assert len(clusters(np.empty(0), 0.02, 2, 4)[0]) == 0


def test_joints_lie_below_surfaces_and_unknown_pixels_have_none() -> None:
    depth = np.full((20, 20), 2000, np.uint16)
    depth[:, :10] = 1000
    pixels = np.array([[9.5, 10.0], [np.nan, np.nan], [500.0, 10.0], [np.inf, 3.0]])
    radii = np.array([0.1, 0.1, 0.1, 0.1])
    places, shares, counts = surfaces_about(
        depth, 0.001, pixels, np.full(4, 3.0), radii, (0.02, 0.3), (3, 4)
    )
    assert counts.tolist() == [2, 0, 0, 0]
    np.testing.assert_allclose(np.sort(places[0, :2]), [1.1, 2.1])
    np.testing.assert_allclose(shares[0].sum(), 1.0)
    assert surfaces_about(depth, 0.001, pixels, np.full(4, 3.0), radii, (0.02, 1.5), (3, 4))[
        2
    ].tolist() == [1, 0, 0, 0]
