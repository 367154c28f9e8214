"""Things that seem to leave by themselves the place where they lie, on tracks made by hand."""

import numpy as np
import pytest
from carried_cup import through
from inhand_outcomes.leaps import without_leaps
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track
from inhand_schemas.joints import Joint
from numpy.typing import NDArray

CUBE = 0.04 * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
PHONE = Thing("phone", "", CUBE, np.zeros((0, 3), np.int64))
TABLE, SIDE, EAR, SHELF = (
    np.array(place)
    for place in ([0.5, 0.3, 0.8], [0.3, -0.2, 0.75], [0.1, -0.3, 1.6], [-0.6, 0.4, 1.2])
)


def track(
    phone: NDArray[np.float64], hand: NDArray[np.float64], times: NDArray[np.float64]
) -> Track:
    """A phone (T, 3) and a right hand (T, 3), seen all the time; the left hand hangs."""
    joints = np.tile([0.0, -0.3, 1.0], (len(times), 20, 1))
    joints[:, Joint.HAND_LEFT] = [-0.4, -0.3, 0.75]
    joints[:, Joint.HAND_RIGHT] = hand
    return Track(
        times,
        np.hstack([phone, np.tile([1.0, 0.0, 0.0, 0.0], (len(times), 1))]),
        np.tile(0.02**2 * np.eye(6), (len(times), 1, 1)),
        np.ones(len(times), bool),
        joints,
    )


def leapt(times: NDArray[np.float64], to: NDArray[np.float64]) -> NDArray[np.float64]:
    """A phone on the table that is told elsewhere from 3 to 5 s."""
    away = (times >= 3.0) & (times < 5.0)
    return np.where(away[:, None], to, TABLE)


@pytest.mark.parametrize("rate", [8.0, 30.0])
def test_a_phone_on_the_table_is_not_at_the_ear_that_a_hand_scratches(rate: float) -> None:
    times = np.arange(0.0, 8.0, 1.0 / rate)
    hand = through(times, (2.5, SIDE), (3.0, EAR), (5.0, EAR), (5.5, SIDE))
    seen = without_leaps(track(leapt(times, EAR), hand, times), PHONE).seen
    np.testing.assert_array_equal(seen, (times < 3.0) | (times >= 5.0))


@pytest.mark.parametrize("seconds", [0.3, 1.5])
def test_what_a_hand_takes_fast_or_slowly_is_seen_all_the_way(seconds: float) -> None:
    times = np.arange(0.0, 8.0, 1.0 / 30.0)
    ways = [(2.0, TABLE), (2.0 + seconds, EAR), (5.0, EAR), (6.0, TABLE)]
    hand = through(times, (1.5, SIDE), *ways, (6.5, SIDE))
    noise = 0.01 * np.random.default_rng(5).normal(size=(len(times), 3))
    assert without_leaps(track(through(times, *ways) + noise, hand, times), PHONE).seen.all()


def test_a_hand_that_was_there_and_left_without_it_did_not_take_it() -> None:
    times = np.arange(0.0, 8.0, 1.0 / 30.0)
    hand = through(times, (1.0, SIDE), (1.3, TABLE), (1.6, SIDE), (2.5, SIDE), (3.0, EAR))
    only_passed = without_leaps(track(leapt(times, EAR), hand, times), PHONE).seen
    assert not only_passed[(times > 3.1) & (times < 4.9)].any()


def test_what_lies_elsewhere_never_lay_where_it_seemed_to() -> None:
    times = np.arange(0.0, 8.0, 1.0 / 30.0)
    hand = np.tile(SIDE, (len(times), 1))
    phone = np.where(times[:, None] >= 3.0, SHELF, TABLE)
    seen = without_leaps(track(phone, hand, times), PHONE).seen
    assert not seen[(times > 3.1) & (times < 3.5)].any()
    assert seen[times > 4.0].all()


def test_where_no_hand_is_known_nothing_is_a_leap() -> None:
    times = np.arange(0.0, 8.0, 1.0 / 30.0)
    hand = np.full((len(times), 3), np.nan)
    assert without_leaps(track(leapt(times, EAR), hand, times), PHONE).seen.all()
