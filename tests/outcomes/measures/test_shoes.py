"""A shoe that comes to a foot, stays, and leaves."""

import numpy as np
import pytest
from inhand_outcomes.measures.shoes import shoes
from inhand_outcomes.thing import Thing
from standing_person import FOOT, beside, frame_times, going, track_of

SHOE = Thing(
    "shoe",
    "shoes",
    np.array([[x, y, z] for x in (-0.05, 0.05) for y in (-0.08, 0.2) for z in (0.0, 0.1)]),
    np.zeros((0, 3), np.int64),
)
MIDDLE = np.array([0.0, 0.06, 0.05])


def test_a_shoe_is_put_on_and_taken_off_once_each() -> None:
    times = frame_times(10.0)
    toes = beside(FOOT, 0.0, 0.25, 0.05)
    way = going(times, (2.0, toes), (3.0, FOOT), (6.0, FOOT), (7.0, toes)) - MIDDLE
    on, off = shoes(track_of(times, way), SHOE)
    assert (on.kind, off.kind) == ("shoe_on", "shoe_off")
    # Halfway from the toes it is on for those who see feet within some centimetres.
    assert on.end_s == pytest.approx(2.5, abs=0.3)
    assert off.end_s == pytest.approx(6.5, abs=0.3)
    assert min(on.probability, off.probability) > 0.9


def test_a_shoe_that_stands_beside_a_foot_or_is_worn_all_the_time_gives_no_event() -> None:
    times = frame_times(10.0)
    standing = np.tile(beside(FOOT, 0.15, 0.0, 0.0) - MIDDLE, (len(times), 1))
    worn = np.tile(FOOT - MIDDLE, (len(times), 1))
    assert shoes(track_of(times, standing), SHOE) == []
    assert shoes(track_of(times, worn), SHOE) == []
