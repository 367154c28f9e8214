"""Running medians against those of all values."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from inhand_runtime.running_medians import RunningMedians

ROWS = 3
values = st.one_of(st.just(np.nan), st.sampled_from([0.1, 0.2, 0.3]), st.floats(0.0, 1.0))


@given(st.lists(st.lists(values, min_size=ROWS, max_size=ROWS), max_size=25), st.integers(1, 8))
def test_running_medians_are_those_of_the_last_values(rows: list[list[float]], kept: int) -> None:
    running = RunningMedians(ROWS, kept)
    for number, row in enumerate(rows):
        window = np.array(rows[max(number + 1 - kept, 0) : number + 1])
        expected = [
            np.median(column[np.isfinite(column)]) if np.isfinite(column).any() else np.nan
            for column in window.T
        ]
        np.testing.assert_array_equal(running.update(np.array(row)), expected)
        np.testing.assert_array_equal(running.counts, np.isfinite(window).sum(axis=0))
