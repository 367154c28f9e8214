"""Taking up, putting down and dropping, on tracks made by hand."""

from dataclasses import replace

import numpy as np
import pytest
from carried_cup import through
from hypothesis import given
from hypothesis import strategies as st
from inhand_outcomes.achievement import Achievement
from inhand_outcomes.handling import DROPPED, LEFT_IN_USE, PUT_DOWN, TAKEN_UP, handling
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track
from inhand_schemas.joints import Joint
from numpy.typing import NDArray

RATE_HZ = 30.0
CUBE = 0.04 * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
THING = Thing("cup", "", CUBE, np.zeros((0, 3), np.int64))
TABLE, ELSEWHERE, CHEST, SIDE = (
    np.array(place)
    for place in ([0.4, 0.3, 0.8], [0.1, 0.6, 0.8], [0.1, 0.2, 1.2], [0.3, -0.2, 0.75])
)


def track(
    times: NDArray[np.float64],
    object_places: NDArray[np.float64],
    hand_places: NDArray[np.float64],
    deviation_m: float = 0.01,
) -> Track:
    """A person of 1.7 m who stands at the origin and has a thing in the right hand, or not."""
    joints = np.tile([0.0, -0.3, 1.0], (len(times), 20, 1))
    joints[:, Joint.HEAD] = [0.0, -0.3, 1.6]
    joints[:, (Joint.FOOT_LEFT, Joint.FOOT_RIGHT, Joint.ANKLE_LEFT, Joint.ANKLE_RIGHT)] = 0.0
    joints[:, Joint.HAND_LEFT] = [-0.4, -0.3, 0.75]
    joints[:, Joint.HAND_RIGHT] = hand_places
    return Track(
        times,
        np.hstack([object_places, np.tile([1.0, 0.0, 0.0, 0.0], (len(times), 1))]),
        np.tile(deviation_m**2 * np.eye(6), (len(times), 1, 1)),
        np.ones(len(times), bool),
        joints,
    )


def carried() -> Track:
    """Somebody takes a cup from a table at 2 s, and puts it down elsewhere at 6 s."""
    times = np.arange(0.0, 9.0, 1.0 / RATE_HZ)
    places = through(times, (2.0, TABLE), (3.0, CHEST), (5.0, CHEST), (6.0, ELSEWHERE))
    hand = through(
        times, (1.0, SIDE), (2.0, TABLE), (3.0, CHEST), (5.0, CHEST), (6.0, ELSEWHERE), (7.0, SIDE)
    )
    return track(times, places, hand)


def kinds(achievements: list[Achievement]) -> list[str]:
    return [one.kind for one in achievements]


def test_what_is_carried_elsewhere_is_taken_up_and_put_down_there() -> None:
    taken, put = handling(carried(), THING)
    assert (taken.kind, put.kind) == (TAKEN_UP, PUT_DOWN)
    assert taken.end_s == pytest.approx(2.0, abs=0.5)
    assert put.end_s == pytest.approx(6.0, abs=0.5)
    assert taken.probability > 0.99
    assert put.probability > 0.99
    place = [put.amounts[f"place_{axis}_m"].value for axis in "xyz"]
    np.testing.assert_allclose(place, ELSEWHERE, atol=1e-6)
    assert put.amounts["place_x_m"].deviation == pytest.approx(0.01)


def test_what_is_touched_and_not_moved_is_not_taken_up() -> None:
    times = np.arange(0.0, 6.0, 1.0 / RATE_HZ)
    places = np.tile(TABLE, (len(times), 1))
    hand = through(times, (1.0, SIDE), (2.0, TABLE), (3.0, TABLE), (4.0, SIDE))
    assert handling(track(times, places, hand), THING) == []


def test_what_is_held_still_is_not_put_down() -> None:
    times = np.arange(0.0, 20.0, 1.0 / RATE_HZ)
    places = np.tile(CHEST, (len(times), 1))
    assert handling(track(times, places, places), THING) == []


def test_what_nobody_put_on_the_floor_was_dropped() -> None:
    times = np.arange(0.0, 8.0, 1.0 / RATE_HZ)
    floor = np.array([*CHEST[:2], 0.04])
    places = through(times, (2.0, TABLE), (3.0, CHEST), (4.0, CHEST), (4.5, floor))
    hand = through(times, (1.0, SIDE), (2.0, TABLE), (3.0, CHEST))
    assert kinds(handling(track(times, places, hand), THING)) == [TAKEN_UP, DROPPED]


def test_what_goes_out_of_view_in_a_hand_is_left_in_use() -> None:
    times = np.arange(0.0, 5.0, 1.0 / RATE_HZ)
    places = through(times, (2.0, TABLE), (3.0, CHEST))
    hand = through(times, (1.0, SIDE), (2.0, TABLE), (3.0, CHEST))
    seen = track(times, places, hand)
    assert kinds(handling(seen, THING, ended=True)) == [TAKEN_UP, LEFT_IN_USE]
    assert kinds(handling(seen, THING)) == [TAKEN_UP]


def test_poses_that_are_not_seen_are_no_evidence() -> None:
    whole = carried()
    unseen = replace(whole, seen=np.zeros(len(whole), bool))
    assert handling(unseen, THING, ended=True) == []


def test_a_move_within_the_error_of_its_place_is_improbable() -> None:
    times = np.arange(0.0, 9.0, 1.0 / RATE_HZ)
    near = np.add(TABLE, [0.08, 0.0, 0.0])
    places = through(times, (2.0, TABLE), (3.0, near))
    hand = through(times, (1.0, SIDE), (2.0, TABLE), (3.0, near), (4.0, SIDE))
    surely, unsurely = (
        max((one.probability for one in handling(moved, THING)), default=0.0)
        for moved in (track(times, places, hand, deviation) for deviation in (0.002, 0.05))
    )
    assert surely > 0.99
    assert unsurely < 0.75


@given(
    turn=st.floats(-np.pi, np.pi), x=st.floats(-3.0, 3.0), rate=st.sampled_from([7.0, 15.0, 60.0])
)
def test_the_view_and_the_frame_rate_change_nothing(turn: float, x: float, rate: float) -> None:
    whole = carried()
    frames = np.unique(np.searchsorted(whole.times, np.arange(0.0, 8.9, 1.0 / rate)))
    part = whole[frames]
    rotation = np.array(
        [[np.cos(turn), -np.sin(turn), 0.0], [np.sin(turn), np.cos(turn), 0.0], [0.0, 0.0, 1.0]]
    )
    poses = part.poses.copy()
    poses[:, :3] = part.positions @ rotation.T + [x, 0.0, 0.0]
    poses[:, 3:] = [np.cos(turn / 2), 0.0, 0.0, np.sin(turn / 2)]
    joints = part.joints @ rotation.T + [x, 0.0, 0.0]
    moved = Track(part.times, poses, part.covariances, part.seen, joints)
    assert kinds(handling(moved, THING)) == [TAKEN_UP, PUT_DOWN]


def test_what_is_seen_elsewhere_without_a_hand_that_took_it_is_not_taken_up() -> None:
    times = np.arange(0.0, 9.0, 1.0 / RATE_HZ)
    far = np.add(TABLE, [0.9, 0.0, 0.0])
    hand = np.tile(CHEST, (len(times), 1))
    places = through(times, (3.0, far), (3.3, CHEST), (5.0, CHEST), (5.3, far))
    found = handling(track(times, places, hand), THING)
    assert all(one.probability < 0.01 for one in found)


def test_what_lies_near_a_hand_that_goes_out_of_view_is_not_left_in_use() -> None:
    times = np.arange(0.0, 5.0, 1.0 / RATE_HZ)
    lying = track(times, np.tile(TABLE, (len(times), 1)), np.tile(TABLE, (len(times), 1)))
    (left,) = handling(lying, THING, ended=True)
    assert left.probability < 0.01


def test_what_is_drawn_to_a_hand_along_the_sight_was_neither_taken_up_nor_put_down() -> None:
    times = np.arange(0.0, 9.0, 1.0 / RATE_HZ)
    farther = np.add(TABLE, [0.02, 0.2, 0.0])
    way = [(2.3, TABLE), (3.0, farther), (5.0, farther), (5.7, TABLE)]
    hand = through(times, (1.5, SIDE), *way, (6.5, SIDE))
    flute = track(times, through(times, *way), hand)
    along_y = np.diag(np.square([0.012, 0.04, 0.012, 0.1, 0.1, 0.1]))
    drawn = replace(flute, covariances=np.tile(along_y, (len(times), 1, 1)))
    across = replace(drawn, poses=flute.poses[:, [1, 0, *range(2, 7)]])
    across = replace(across, joints=flute.joints[:, :, [1, 0, 2]])
    assert all(one.probability < 0.1 for one in handling(drawn, THING))
    taken, put = handling(across, THING)
    assert min(taken.probability, put.probability) > 0.9


def test_what_is_told_elsewhere_for_a_moment_was_not_taken_up() -> None:
    times = np.arange(0.0, 9.0, 1.0 / RATE_HZ)
    beside = np.add(TABLE, [0.14, 0.0, 0.0])
    hand = through(times, (1.5, SIDE), (2.5, beside), (4.0, beside), (5.0, SIDE))
    for_a_moment = (times > 3.0) & (times < 3.25)
    places = np.where(for_a_moment[:, None], beside, TABLE)
    assert all(one.probability < 0.1 for one in handling(track(times, places, hand), THING))


@pytest.mark.parametrize(("hidden_s", "likely"), [(2.0, True), (8.0, False)])
def test_what_lies_long_after_a_hand_held_something_was_put_there_less_probably(
    hidden_s: float, likely: bool
) -> None:
    times = np.arange(0.0, 16.0, 1.0 / RATE_HZ)
    way, shown_s = [(2.0, TABLE), (3.0, CHEST), (4.0, CHEST), (5.5, ELSEWHERE)], 4.0 + hidden_s
    hand = through(times, (1.0, SIDE), *way, (shown_s - 0.5, ELSEWHERE), (shown_s, SIDE))
    hidden = (times > 4.0) & (times < shown_s)
    seen = replace(track(times, through(times, *way), hand), seen=~hidden)
    (put,) = (one for one in handling(seen, THING) if one.kind == PUT_DOWN)
    assert (put.probability > 0.5) is likely


def test_who_takes_a_thing_up_slowly_surely_takes_it_up() -> None:
    times = np.arange(0.0, 9.0, 1.0 / RATE_HZ)
    ways = [(2.0, TABLE), (4.0, np.add(TABLE, [0.0, 0.0, 0.1])), (5.0, CHEST)]
    whole = track(times, through(times, *ways), through(times, (1.0, SIDE), *ways), 0.015)
    until = [np.searchsorted(times, end) for end in np.arange(2.5, 9.0, 0.5)]
    said = [one for end in until for one in handling(whole[:end], THING)]
    assert said
    assert min(one.probability for one in said) > 0.9
