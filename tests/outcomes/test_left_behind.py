"""Things that a tracker loses as the hand leaves them, on tracks made by hand."""

from dataclasses import replace

import numpy as np
import pytest
from carried_cup import CUP, a_person, a_pose, through
from inhand_outcomes.handling import PUT_DOWN, TAKEN_UP, handling
from inhand_outcomes.room import Room
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track
from inhand_outcomes.watching import Watcher
from inhand_schemas.joints import Joint
from inhand_schemas.messages import Skeletons
from numpy.typing import NDArray

CUBE = 0.04 * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
THING = Thing("glasses", "", CUBE, np.zeros((0, 3), np.int64))
TABLE, ELSEWHERE, CHEST, SIDE, HEAD, FAR, NEAR = (
    np.array(place)
    for place in (
        *([0.4, 0.3, 0.8], [0.1, 0.6, 0.8], [0.1, 0.2, 1.2]),
        *([0.3, -0.2, 0.75], [0.0, -0.3, 1.6], [0.6, 1.0, 1.0], [0.1, 0.7, 0.8]),
    )
)
LEFT_S = 6.8
"""When the hand has left the thing, in what follows."""


def put_down(*, then: NDArray[np.float64], hand_after: NDArray[np.float64] = SIDE) -> Track:
    """Somebody puts a thing down elsewhere at 6 s, and lets go of it from 6.5 s on; it is seen
    where ``then`` says from 6.8 s on, and wanders there."""
    times = np.arange(0.0, 9.0, 1.0 / 30.0)
    ways = [(2.0, TABLE), (3.0, CHEST), (5.0, CHEST), (6.0, ELSEWHERE)]
    places = through(times, *ways)
    lost = times >= LEFT_S
    wander = 0.08 * np.random.default_rng(3).normal(size=(int(lost.sum()), 3))
    places[lost] = then + wander
    joints = np.tile([0.0, -0.3, 1.0], (len(times), 20, 1))
    joints[:, Joint.HEAD] = HEAD
    joints[:, Joint.HAND_LEFT] = [-0.4, -0.3, 0.75]
    hand = through(times, (1.0, SIDE), *ways, (6.5, ELSEWHERE), (7.2, hand_after))
    joints[:, Joint.HAND_RIGHT] = hand
    return Track(
        times,
        np.hstack([places, np.tile([1.0, 0.0, 0.0, 0.0], (len(times), 1))]),
        np.tile(0.01**2 * np.eye(6), (len(times), 1, 1)),
        np.ones(len(times), bool),
        joints,
    )


@pytest.mark.parametrize("leapt", [FAR, HEAD, NEAR])
def test_what_leaps_as_the_hand_leaves_lies_where_it_rested(leapt: NDArray[np.float64]) -> None:
    taken, put = handling(put_down(then=leapt), THING)
    assert (taken.kind, put.kind) == (TAKEN_UP, PUT_DOWN)
    assert put.probability > 0.9
    place = [put.amounts[f"place_{axis}_m"].value for axis in "xyz"]
    np.testing.assert_allclose(place, ELSEWHERE, atol=0.01)
    # It is less sure than what is seen to lie, which is known to 1 cm here.
    assert put.amounts["place_x_m"].deviation > 0.015


def test_the_last_place_where_it_rested_counts() -> None:
    track = put_down(then=ELSEWHERE)
    track.poses[track.times >= LEFT_S, :3] = ELSEWHERE
    before = (track.times > 5.2) & (track.times < 5.95)
    track.poses[before, :3] = track.joints[before, Joint.HAND_RIGHT] = ELSEWHERE + 0.09
    put = handling(track, THING)[-1]
    place = [put.amounts[f"place_{axis}_m"].value for axis in "xyz"]
    np.testing.assert_allclose(place, ELSEWHERE, atol=0.01)


def test_what_the_hand_stays_at_or_takes_along_is_not_put_down() -> None:
    held = put_down(then=FAR, hand_after=ELSEWHERE)
    assert [one.kind for one in handling(held, THING)] == [TAKEN_UP]
    carried = put_down(then=ELSEWHERE)
    later = carried.times >= 6.5
    carried.poses[later, :3] = carried.joint(Joint.HAND_RIGHT)[later]
    assert [one.kind for one in handling(carried, THING)] == [TAKEN_UP]


def test_what_seemed_to_be_in_a_hand_for_a_moment_is_not_put_down_there() -> None:
    track = put_down(then=ELSEWHERE)
    track.poses[:, :3] = TABLE
    moment = (track.times > 6.0) & (track.times < LEFT_S)
    track.poses[moment, :3] = ELSEWHERE
    assert [one for one in handling(track, THING) if one.probability > 0.1] == []


def test_what_is_not_seen_any_more_says_nothing() -> None:
    track = put_down(then=FAR)
    unseen = replace(track, seen=track.times < 6.5)
    assert [one.kind for one in handling(unseen, THING)] == [TAKEN_UP]


def test_its_place_in_the_rig_is_where_it_rested_whatever_the_room_is() -> None:
    watcher = Watcher({"cup": CUP}, "inhand/rig")
    watcher.room = Room(np.array([0.1, -0.9, -0.4]) / np.linalg.norm([0.1, -0.9, -0.4]), -1.2)
    table, chest, place, side = (
        np.array(one)
        for one in ([0.4, 0.2, 2.0], [0.1, -0.2, 2.1], [0.1, 0.2, 2.3], [0.3, 0.5, 1.7])
    )
    times = np.arange(0.0, 8.5, 1.0 / 30.0)
    ways = [(2.0, table), (3.0, chest), (5.0, chest), (6.0, place)]
    cups = np.where(
        times[:, None] < LEFT_S, through(times, *ways), place + np.array([0.5, -0.3, 0.4])
    )
    hands = through(times, (1.0, side), *ways, (6.5, place), (7.2, side))
    outcomes = []
    for number, (second, cup, hand) in enumerate(zip(times, cups, hands, strict=True)):
        time_ns = round(second * 1e9)
        people = (a_person(0, hand),)
        seen = Skeletons(sequence=number, time_ns=time_ns, people=people)
        outcomes += watcher.hear_skeletons("front", seen)
        outcomes += watcher.hear_pose(a_pose("cup", number, time_ns, 0, cup))
    outcomes += watcher.end_all()
    assert [one.kind for one in outcomes] == [TAKEN_UP, PUT_DOWN]
    assert outcomes[1].rig_from_object is not None
    np.testing.assert_allclose(outcomes[1].rig_from_object.translation, place, atol=0.01)
