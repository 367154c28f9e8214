"""Wild lengths against their definition."""

import numpy as np
from inhand_tracker.body.kernels.part_lengths import in_proportion


def test_a_wild_length_gets_what_the_others_make_one_expect() -> None:
    proportions = np.array([1.0, 2.0, 3.0, 4.0, 5.0])
    lengths = np.array([0.1, 0.2, 0.3, 0.9, np.nan])
    np.testing.assert_allclose(
        in_proportion(lengths, proportions, 2.0), [0.1, 0.2, 0.3, 0.4, np.nan]
    )
    nothing = np.full(5, np.nan)
    np.testing.assert_array_equal(in_proportion(nothing, proportions, 2.0), nothing)
