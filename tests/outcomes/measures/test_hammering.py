"""Strikes of a hammer that swings about a wrist, falls ever faster and is stopped."""

import numpy as np
import pytest
from hand_made import moved, thing, track
from hypothesis import given, settings
from hypothesis import strategies as st
from inhand_outcomes.measures.hammering import hammering
from scipy.spatial.transform import Rotation

HAMMER = thing(
    "hammer",
    ([-0.01, -0.01, -0.16], [0.01, 0.01, 0.16]),
    ([-0.01, -0.07, 0.13], [0.01, 0.06, 0.16]),
)
WRIST = np.array([0.0, 0.0, -0.25])
"""What it swings about: an elbow beyond the handle's end, in the hammer's frame."""


def swung(angles, turn=0.0):
    """A hammer swung back by angles (T,) about the level axis x, its face ahead at 0."""
    rotations = Rotation.from_euler("z", turn) * Rotation.from_euler("x", angles[:, None])
    middle = np.array([0.3, 1.5, 1.0])
    return Rotation.from_euler("z", turn).apply(middle) - rotations.apply(WRIST), rotations


def hammer(*, rate=30.0, count=4, beat=0.6, swing=0.9, turn=0.0, struck=True, seed=0):
    """Swings of a beat from 1 s on: 0.35 s back at leisure, then ahead into the nail, or waved."""
    times = np.arange(0.0, count * beat + 3.0, 1.0 / rate)
    angles = np.zeros(len(times))
    for number in range(count):
        start = 1.0 + number * beat
        up = moved(times, [(start, 0.0), (start + 0.35, 1.0)])[:, 0]
        share = np.clip((times - start - 0.35) / (beat - 0.35), 0.0, 1.0)
        down = (
            share**2 if struck else moved(times, [(start + 0.35, 0.0), (start + beat, 1.0)])[:, 0]
        )
        angles += swing * (up - down)
    angles += 0.3 * moved(times, [(1.0 + count * beat, 0.0), (1.5 + count * beat, 1.0)])[:, 0]
    positions, rotations = swung(angles, turn)
    noise = np.random.default_rng(seed).normal(0.0, 0.003, positions.shape)
    return track(times, positions + noise, rotations)


def strikes(found):
    return [one for one in found if one.probability > 0.5]


def test_counts_strikes_and_says_rate_and_speed():
    found = strikes(hammering(hammer(), HAMMER))
    assert [one.end_s for one in found] == pytest.approx([1.6, 2.2, 2.8, 3.4], abs=0.06)
    assert found[1].amounts["rate_per_min"].value == pytest.approx(100.0, rel=0.08)
    # 0.9 rad in 0.25 s evenly faster ends at 7.2 rad/s, 0.40 m and 0.06 m from the elbow.
    speed = 7.2 * np.hypot(0.40, 0.06)
    assert found[1].amounts["speed_m_s"].value == pytest.approx(speed, rel=0.25)


def test_a_hammer_that_is_waved_or_set_down_strikes_nothing():
    assert strikes(hammering(hammer(struck=False, beat=0.9), HAMMER)) == []
    assert strikes(hammering(hammer(swing=0.2), HAMMER)) == []


def test_what_was_not_seen_is_no_strike():
    unseen = hammer()
    unseen.seen[(unseen.times > 1.9) & (unseen.times < 2.25)] = False
    assert len(strikes(hammering(unseen, HAMMER))) == 3


def test_a_strike_at_the_end_of_a_window_waits_until_the_hammer_goes_back():
    whole = hammer()
    assert len(strikes(hammering(whole[whole.times < 2.22], HAMMER))) == 1
    assert len(strikes(hammering(whole[whole.times < 2.6], HAMMER))) == 2


@settings(max_examples=8, deadline=None)
@given(
    turn=st.floats(-3.0, 3.0), rate=st.sampled_from([30.0, 45.0, 60.0]), beat=st.floats(0.55, 0.9)
)
def test_neither_heading_nor_frame_rate_nor_pace_changes_the_count(turn, rate, beat):
    assert len(strikes(hammering(hammer(turn=turn, rate=rate, beat=beat), HAMMER))) == 4
