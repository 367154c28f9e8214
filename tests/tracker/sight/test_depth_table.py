import numpy as np
import pytest
from inhand_tracker.sight.depth_table import depth_table
from inhand_tracker.sight.kernels.weigh import DEPTH_COLUMNS, DEPTH_ROWS
from inhand_tracker.sight.parameters import DEFAULT_SIGHT

MIDDLE = DEPTH_COLUMNS // 2


def test_a_depth_at_the_surface_speaks_for_it_the_more_the_nearer_it_is() -> None:
    table = depth_table(0.9, 0.05, DEFAULT_SIGHT)
    assert table.shape == (DEPTH_ROWS, DEPTH_COLUMNS)
    assert table[8, MIDDLE] == table[8].max() > 3.0
    assert table[8, MIDDLE] > table[40, MIDDLE]


def test_something_in_front_says_nothing_and_something_behind_speaks_against() -> None:
    table = depth_table(0.9, 0.045, DEFAULT_SIGHT)
    np.testing.assert_allclose(table[:, 0], 0.0, atol=1e-6)
    np.testing.assert_allclose(table[:, -1], np.log(0.05), atol=1e-6)


@pytest.mark.parametrize("behind", [0.0, 0.01])
def test_an_error_of_the_sensor_is_never_impossible(behind: float) -> None:
    table = depth_table(0.9, behind, DEFAULT_SIGHT)
    np.testing.assert_allclose(table[:, -1], np.log(DEFAULT_SIGHT.least_behind), atol=1e-6)


def test_of_a_surface_that_returns_no_depth_no_depth_speaks_for_it() -> None:
    assert depth_table(0.0, 0.5, DEFAULT_SIGHT).max() <= 0.0
