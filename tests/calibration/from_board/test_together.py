"""While cameras look, places in which two saw the board together are counted."""

import numpy as np
from inhand_calibration.from_board.together import PlacesTogether


def test_a_place_counts_once_and_only_where_both_see_it_at_the_same_time() -> None:
    places = PlacesTogether()
    for place in range(5):
        for repeat in range(4):
            now = 2.0 * place + 0.03 * repeat
            places.note("left", now, np.array([100.0 + 50.0 * place, 80.0]))
            places.note("front", now + 0.01, np.array([300.0, 200.0 + repeat]))
    places.note("right", 100.0, np.array([10.0, 10.0]))
    counts = places.counts(("front", "left", "right"))
    # Between two places the front camera's last sight is too old.
    assert counts == {("front", "left"): 5, ("front", "right"): 0, ("left", "right"): 0}
