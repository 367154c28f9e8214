"""Which frame of a demonstration is drawn."""

import numpy as np
from inhand_lab.demonstration.typical_frame import order_from_median


def test_the_frame_of_the_median_error_is_the_most_typical_one() -> None:
    errors = np.array([0.9, 0.1, 0.4, 0.2, 0.3])
    assert order_from_median(errors)[0] == 4
    assert order_from_median(errors)[-1] in (0, 1)
