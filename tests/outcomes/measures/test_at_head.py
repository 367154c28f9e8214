"""Calls, takes, playing, wearing and reading of somebody who stands: how long, and what is none."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from inhand_outcomes.arrays import Array
from inhand_outcomes.measures.filming import filming
from inhand_outcomes.measures.phoning import phoning
from inhand_outcomes.measures.playing import playing
from inhand_outcomes.measures.reading import reading
from inhand_outcomes.measures.wearing import wearing
from inhand_outcomes.thing import Thing
from scipy.spatial.transform import Rotation
from standing_person import (
    EYES,
    HEAD,
    MOUTH,
    beside,
    elsewhere,
    frame_times,
    going,
    track_of,
    turns,
)

WAITING = np.array([0.1, 0.4, 1.2])
EAR = beside(HEAD, 0.09, 0.0, -0.02)


def block(use: str, low: tuple[float, ...], high: tuple[float, ...]) -> Thing:
    """A thing of the size of a box, as eight vertices."""
    ends = np.array([low, high])
    corners = np.array([[ends[b >> i & 1, i] for i in range(3)] for b in range(8)])
    return Thing(use, use, corners, np.zeros((0, 3), np.int64))


PHONE = block("phone", (-0.035, -0.005, -0.075), (0.035, 0.005, 0.075))
CAMERA = block("camera", (-0.07, -0.05, -0.05), (0.07, 0.05, 0.05))
FLUTE = block("flute", (-0.01, -0.33, -0.01), (0.01, 0.33, 0.01))
GLASSES = block("glasses", (-0.07, -0.14, -0.02), (0.07, 0.0, 0.02))
MAGNIFIER = block("magnifier", (-0.05, -0.004, -0.168), (0.05, 0.004, 0.05))


def visit(times: Array, place: Array, start_s: float, end_s: float) -> Array:
    """A way (T, 3) from before the chest to a place, there from start to end, and back."""
    return going(
        times,
        (start_s - 0.6, WAITING),
        (start_s, place),
        (end_s, place),
        (end_s + 0.6, WAITING),
    )


def test_calls_last_while_the_phone_is_at_either_ear() -> None:
    times = frame_times(16.0)
    left = beside(HEAD, -0.09, 0.0, -0.02)
    way = np.where(
        times[:, None] < 7.5, visit(times, EAR, 2.0, 5.0), visit(times, left, 10.0, 14.0)
    )
    calls = phoning(track_of(times, way), PHONE)
    assert [call.kind for call in calls] == ["call", "call"]
    assert all(call.lasting and call.probability > 0.9 for call in calls)
    durations = [call.amounts["duration_s"].value for call in calls]
    assert durations == pytest.approx([3.0, 4.0], abs=0.5)


@given(seconds=st.floats(0.0, 500.0), heading=st.floats(-3.0, 3.0), rate=st.sampled_from([6, 30]))
@settings(max_examples=10)
def test_a_call_is_the_same_whenever_wherever_and_however_often_seen(
    seconds: float, heading: float, rate: int
) -> None:
    times = frame_times(10.0, rate)
    track = track_of(times, visit(times, EAR, 3.0, 6.0))
    kept = np.random.default_rng(rate).random(len(track)) > 0.2
    (call,) = phoning(elsewhere(track, seconds, heading, kept), PHONE)
    assert call.start_s - seconds == pytest.approx(3.0, abs=0.4)
    assert call.amounts["duration_s"].value == pytest.approx(3.0, abs=0.5)


def test_a_phone_before_the_mouth_or_past_the_head_or_unseen_is_no_call() -> None:
    times = frame_times(10.0)
    dictating = visit(times, beside(MOUTH, 0.0, 0.06, 0.0), 3.0, 6.0)
    passing = visit(times, EAR, 3.0, 3.1)
    assert phoning(track_of(times, dictating), PHONE) == []
    assert phoning(track_of(times, passing), PHONE) == []
    talking = visit(times, EAR, 3.0, 6.0)
    assert phoning(track_of(times, talking, seen=times < 2.0), PHONE) == []


def test_a_take_has_its_duration_and_where_the_camera_points() -> None:
    times = frame_times(9.0)
    way = visit(times, beside(HEAD, 0.0, 0.3, 0.0), 2.0, 6.0)
    turned = Rotation.from_euler("zx", [30.0, 10.0], degrees=True)
    (take,) = filming(track_of(times, way, Rotation.concatenate([turned] * len(times))), CAMERA)
    # It is up for half of the ways of 0.6 s, too.
    assert take.amounts["duration_s"].value == pytest.approx(4.6, abs=0.3)
    y = turned.apply([0.0, 1.0, 0.0])
    assert take.amounts["azimuth_deg"].value == pytest.approx(np.degrees(np.arctan2(-y[0], y[1])))
    assert take.amounts["elevation_deg"].value == pytest.approx(np.degrees(np.arcsin(y[2])))


def test_a_camera_on_a_shelf_or_pointed_at_the_floor_or_oneself_films_nothing() -> None:
    times = frame_times(9.0)
    way = visit(times, beside(HEAD, 0.0, 0.3, 0.0), 2.0, 6.0)
    nobody = np.tile([0.3, 0.0, 0.9], (len(times), 1))
    assert filming(track_of(times, way, hands=nobody), CAMERA) == []
    for axis, degrees in (("x", -70.0), ("z", 180.0)):
        turned = turns(axis, np.full(len(times), degrees))
        assert filming(track_of(times, way, turned), CAMERA) == []


def test_a_flute_is_played_while_its_hole_is_at_the_lips() -> None:
    times = frame_times(9.0)
    to_right = turns("z", np.full(len(times), -90.0))
    hole = np.array([0.0, -0.33 + 0.066, 0.0])
    way = visit(times, MOUTH, 2.0, 5.0) - to_right.apply(hole)
    (piece,) = playing(track_of(times, way, to_right), FLUTE)
    assert piece.kind == "playing"
    assert piece.amounts["duration_s"].value == pytest.approx(3.0, abs=0.5)
    upright = turns("x", np.full(len(times), 90.0))
    assert (
        playing(
            track_of(times, visit(times, MOUTH, 2.0, 5.0) - upright.apply(hole), upright), FLUTE
        )
        == []
    )


def test_glasses_are_put_on_worn_and_taken_off() -> None:
    times = frame_times(10.0)
    way = visit(times, beside(EYES, 0.0, 0.02, 0.0), 3.0, 6.0)
    found = wearing(track_of(times, way), GLASSES)
    assert sorted(one.kind for one in found) == ["put_on", "taken_off", "worn"]
    by_kind = {one.kind: one for one in found}
    assert all(one.probability > 0.9 for one in found)
    assert by_kind["put_on"].end_s == pytest.approx(3.0, abs=0.3)
    assert by_kind["taken_off"].end_s == pytest.approx(6.0, abs=0.3)
    assert by_kind["worn"].amounts["duration_s"].value == pytest.approx(3.0, abs=0.5)


def test_glasses_in_the_hair_or_at_the_mouth_are_not_worn_and_no_ghost_puts_them_on() -> None:
    times = frame_times(10.0)
    in_hair = visit(times, beside(HEAD, 0.0, 0.08, 0.12), 3.0, 6.0)
    assert wearing(track_of(times, in_hair), GLASSES) == []
    chewed = turns("z", np.full(len(times), 90.0))
    assert wearing(track_of(times, visit(times, MOUTH, 3.0, 6.0), chewed), GLASSES) == []
    nobody = np.tile([0.3, 0.0, 0.9], (len(times), 1))
    ghostly = track_of(times, visit(times, beside(EYES, 0.0, 0.02, 0.0), 3.0, 6.0), hands=nobody)
    assert all(one.probability < 0.5 for one in wearing(ghostly, GLASSES) if one.kind != "worn")


def test_reading_goes_on_from_line_to_line_and_not_where_the_glass_lies() -> None:
    times = frame_times(12.0)
    lying, left, right = ([x, 0.45, z] for x, z in ((0.25, 1.12), (-0.08, 1.3), (0.08, 1.3)))
    lines = [(3.0, left), (5.0, right), (5.6, left), (5.8, left), (7.8, right), (8.0, right)]
    way = going(times, (2.0, lying), *lines, (9.0, lying))
    # The lens's axis along the sight, which goes down by 45 degrees.
    facing = turns("x", np.full(len(times), -45.0))
    holds = (times > 1.9) & (times < 9.2)
    handle = way + facing.apply([0.0, 0.0, -0.168])
    hands = np.where(holds[:, None], handle, [0.3, 0.0, 0.9])
    (read,) = reading(track_of(times, way, facing, hands=hands), MAGNIFIER)
    assert read.start_s == pytest.approx(3.0, abs=0.4)
    assert read.end_s == pytest.approx(8.0, abs=0.4)
    aside = facing * Rotation.from_euler("z", 80.0, degrees=True)
    assert reading(track_of(times, way, aside, hands=handle), MAGNIFIER) == []
