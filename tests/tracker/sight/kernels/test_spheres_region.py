import numpy as np
from inhand_tracker.sight.kernels.spheres_region import spheres_region

LENS = np.array([500.0, 400.0, 320.0, 240.0])


def test_the_region_holds_all_spheres_before_the_camera() -> None:
    centres = np.array([[0.0, 0.0, 1.0], [0.5, -0.2, 2.0], [9.0, 9.0, -1.0], [0.0, 0.0, np.nan]])
    left, top, right, bottom = spheres_region(centres, 0.1, LENS)
    assert (left, right) == (320.0 - 50.0, 320.0 + 125.0 + 25.0)
    assert (top, bottom) == (240.0 - 40.0 - 25.0, 240.0 + 50.0)


def test_there_is_none_where_all_are_behind_the_camera() -> None:
    left, _, right, _ = spheres_region(np.array([[0.0, 0.0, 0.01]]), 0.1, LENS)
    assert left > right
