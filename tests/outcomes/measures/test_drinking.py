"""Sips of somebody who stands, with a mug of known volume."""

import numpy as np
import pytest
from cups import HEIGHT, MUG, RADIUS
from hypothesis import given, settings
from hypothesis import strategies as st
from inhand_outcomes.arrays import Array
from inhand_outcomes.measures.drinking import drinking, sip_volumes
from inhand_outcomes.measures.vessels import inside_of
from inhand_outcomes.track import Track
from inhand_schemas.joints import Joint
from standing_person import MOUTH, elsewhere, frame_times, going, rotations_of, track_of, turns

CHEST = np.array([0.1, 0.35, 1.2])


def held(times: Array, at_mouth: Array, tilt_deg: Array) -> Track:
    """The mug from before the chest, 0, to the mouth, 1, tilted about its lip (T,) towards it."""
    turned = turns("x", tilt_deg)
    lip = CHEST + at_mouth[:, None] * (MOUTH - CHEST)
    return track_of(times, lip - turned.apply([0.0, -RADIUS, HEIGHT]), turned)


def sips(times: Array, starts: list[float], tilts: list[float]) -> Track:
    """Sips of 3 s each: up, tilted for a second at the mouth, and down."""
    near, tilt = [(0.0, 0.0)], [(0.0, 0.0)]
    for start, deepest in zip(starts, tilts, strict=True):
        near += [(start, 0.0), (start + 0.8, 1.0), (start + 2.2, 1.0), (start + 3.0, 0.0)]
        tilt += [(start + 0.8, 8.0), (start + 1.2, deepest), (start + 1.8, deepest)]
        tilt += [(start + 2.2, 8.0), (start + 3.0, 0.0)]
    return held(times, going(times, *near), going(times, *tilt))


def test_two_sips_are_counted_and_the_second_is_what_the_tilts_show() -> None:
    found = sip_volumes(drinking(sips(frame_times(11.0), [1.0, 6.0], [40.0, 52.0]), MUG), [])
    assert [one.kind for one in found] == ["sip", "sip"]
    assert all(one.probability > 0.9 for one in found)
    assert [one.start_s for one in found] == pytest.approx([1.9, 6.9], abs=0.3)
    assert [one.end_s for one in found] == pytest.approx([3.1, 8.1], abs=0.3)
    # By the formula of a cylinder whose bottom is wet: a wedge leaves for each tilt.
    wedge = np.pi * RADIUS**3 * np.diff(np.tan(np.radians([40.0, 51.3]))).item() * 1e6
    assert found[1].amounts["volume_ml"].value == pytest.approx(wedge, rel=0.2)
    assert found[0].amounts["volume_ml"].value == 20.0


def test_a_head_that_is_seen_too_near_behind_the_mug_drinks_all_the_same() -> None:
    track = sips(frame_times(6.0), [1.0], [45.0])
    track.joints[:, Joint.HEAD, 1] += 0.06
    (found,) = drinking(track, MUG)
    assert found.probability > 0.8


def test_raising_the_tilt_twice_at_the_mouth_is_two_sips() -> None:
    times = frame_times(8.0)
    near = going(times, (1.0, 0.0), (1.8, 1.0), (6.0, 1.0), (7.0, 0.0))
    tilt = [(2.0, 8.0), (2.5, 45.0), (3.0, 45.0), (3.6, 18.0), (4.4, 50.0), (5.0, 50.0), (5.5, 8.0)]
    found = drinking(held(times, near, going(times, *tilt)), MUG)
    assert len(found) == 2
    assert np.degrees([one.evidence["tilt_rad"] for one in found]) == pytest.approx([45, 50], abs=3)


@pytest.mark.parametrize(
    ("at_mouth", "tilt_deg"),
    [(0.0, 50.0), (0.5, 25.0), (1.0, 6.0), (1.0, -40.0)],
    ids=["looked into", "gestured with", "smelt at", "tilted away"],
)
def test_a_mug_that_is_not_drunk_from_gives_no_sip(at_mouth: float, tilt_deg: float) -> None:
    times = frame_times(6.0)
    near = going(times, (1.0, 0.0), (2.0, at_mouth), (4.0, at_mouth), (5.0, 0.0))
    tilt = going(times, (1.0, 0.0), (2.0, tilt_deg), (4.0, tilt_deg), (5.0, 0.0))
    assert drinking(held(times, near, tilt), MUG) == []


def test_what_was_not_seen_or_is_cut_by_the_window_is_no_sip() -> None:
    track = sips(frame_times(6.0), [1.0], [45.0])
    hidden = track_of(track.times, track.positions, rotations_of(track), seen=track.times < 1.0)
    assert drinking(hidden, MUG) == []
    assert drinking(track[track.times < 2.5], MUG) == []
    assert drinking(track[track.times > 2.0], MUG) == []


@given(
    seconds=st.floats(0.0, 1000.0), heading=st.floats(-3.0, 3.0), rate=st.sampled_from([8, 30, 60])
)
@settings(max_examples=12)
def test_sips_are_the_same_whenever_wherever_and_however_often_seen(
    seconds: float, heading: float, rate: int
) -> None:
    track = sips(frame_times(10.5, rate), [1.0, 6.0], [38.0, 60.0])
    kept = np.random.default_rng(rate).random(len(track)) > 0.15
    found = sip_volumes(drinking(elsewhere(track, seconds, heading, kept), MUG), [])
    assert len(found) == 2
    assert found[0].start_s - seconds == pytest.approx(1.9, abs=0.35)
    inside = inside_of(MUG)
    assert inside is not None
    poured = inside.holds(np.radians(38.0)) - inside.holds(np.radians(60.0))
    assert found[1].amounts["volume_ml"].value == pytest.approx(poured, rel=0.15)
