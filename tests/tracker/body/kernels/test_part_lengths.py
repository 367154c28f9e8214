"""Running medians against those of all values, and wild lengths against their definition."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from inhand_tracker.body.kernels.part_lengths import exchange, in_proportion, medians

ROWS = 3
values = st.one_of(st.just(np.nan), st.sampled_from([0.1, 0.2, 0.3]), st.floats(0.0, 1.0))


@given(st.lists(st.lists(values, min_size=ROWS, max_size=ROWS), max_size=25), st.integers(1, 8))
def test_running_medians_are_those_of_the_last_values(rows: list[list[float]], kept: int) -> None:
    ordered, counts = np.empty((ROWS, kept)), np.zeros(ROWS, np.int64)
    seen = np.full((max(len(rows), 1) + kept, ROWS), np.nan)
    for number, row in enumerate(rows):
        seen[kept + number] = row
        exchange(ordered, counts, seen[number], seen[kept + number])
        window = seen[number + 1 : kept + number + 1]
        expected = [
            np.median(column[np.isfinite(column)]) if np.isfinite(column).any() else np.nan
            for column in window.T
        ]
        np.testing.assert_array_equal(medians(ordered, counts), expected)


def test_a_wild_length_gets_what_the_others_make_one_expect() -> None:
    proportions = np.array([1.0, 2.0, 3.0, 4.0, 5.0])
    lengths = np.array([0.1, 0.2, 0.3, 0.9, np.nan])
    np.testing.assert_allclose(
        in_proportion(lengths, proportions, 2.0), [0.1, 0.2, 0.3, 0.4, np.nan]
    )
    nothing = np.full(5, np.nan)
    np.testing.assert_array_equal(in_proportion(nothing, proportions, 2.0), nothing)
