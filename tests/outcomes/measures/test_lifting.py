"""Repetitions with a bar that goes up and down before standing and stooping shoulders."""

import numpy as np
import pytest
from hand_made import moved, thing, track
from hypothesis import given, settings
from hypothesis import strategies as st
from inhand_outcomes.measures.lifting import lifting
from inhand_schemas.joints import Joint
from scipy.spatial.transform import Rotation

BAR = thing("bar", ([-0.6, -0.02, -0.02], [0.6, 0.02, 0.02]))


def bar(heights, shoulders, times, *, tilt_deg=0.0, turned=False, heading=0.0, seed=0):
    """A bar at heights (T,) before a person, facing y, whose shoulders are at heights (T,)."""
    count = len(times)
    random = np.random.default_rng(seed)
    around = Rotation.from_euler("z", heading)
    places = np.column_stack([np.zeros(count), np.full(count, 2.3), heights])
    joints = np.full((count, 20, 3), np.nan)
    for joint, aside in (
        (Joint.SHOULDER_CENTER, 0.0),
        (Joint.SHOULDER_LEFT, -0.18),
        (Joint.SHOULDER_RIGHT, 0.18),
    ):
        at = np.column_stack([np.full(count, aside), np.full(count, 2.0), shoulders])
        joints[:, joint] = around.apply(at + random.normal(0.0, 0.01, at.shape))
    level = around * Rotation.from_euler("y", -tilt_deg, degrees=True)
    if turned:
        level = level * Rotation.from_euler("z", np.pi)
    positions = around.apply(places + random.normal(0.0, 0.004, places.shape))
    return track(times, positions, Rotation.concatenate([level] * count), joints=joints)


def curls(count=3, *, up_s=0.8, down_s=1.2, rate=30.0, **how):
    """Curls of 0.5 m from 1 s on, 0.3 s at the top and 0.4 s at the bottom."""
    round_s = up_s + 0.3 + down_s + 0.4
    times = np.arange(0.0, 2.0 + count * round_s + 2.0, 1.0 / rate)
    keys = [(0.0, 0.75)]
    for number in range(count):
        start = 1.0 + number * round_s
        keys += [(start, 0.75), (start + up_s, 1.25), (start + up_s + 0.3, 1.25)]
        keys += [(start + up_s + 0.3 + down_s, 0.75)]
    return bar(moved(times, keys)[:, 0], np.full(len(times), 1.4), times, **how)


def test_says_range_tempo_and_which_side_is_higher():
    for turned in (False, True):
        found = lifting(curls(tilt_deg=5.0, turned=turned), BAR)
        assert len(found) == 3
        amounts = found[1].amounts
        assert found[1].probability > 0.95
        assert amounts["range_m"].value == pytest.approx(0.5, abs=0.02)
        assert amounts["up_s"].value == pytest.approx(0.8, abs=0.2)
        assert amounts["down_s"].value == pytest.approx(1.2, abs=0.2)
        assert found[1].start_s == pytest.approx(3.7, abs=0.2)
        assert amounts["tilt_deg"].value == pytest.approx(5.0, abs=1.0)
        assert amounts["difference_m"].value == pytest.approx(1.2 * np.sin(np.radians(5)), abs=0.02)


def test_stooping_for_a_bar_and_standing_up_with_it_is_no_repetition():
    times = np.arange(0.0, 8.0, 1.0 / 30.0)
    stooped = moved(times, [(1.0, 0.0), (2.2, 1.0), (2.8, 1.0), (4.0, 0.0), (5.0, 0.0), (6.2, 1.0)])
    shoulders = 1.4 - 0.6 * stooped[:, 0]
    lying = (times < 2.5) | (times > 6.3)
    heights = np.where(lying, 0.2, shoulders - 0.6)
    assert lifting(bar(heights, shoulders, times), BAR) == []


def test_half_a_repetition_at_the_end_of_a_window_waits():
    whole = curls()
    assert len(lifting(whole[whole.times < 2.0], BAR)) == 0
    assert len(lifting(whole[whole.times < 3.6], BAR)) == 1


def test_a_repetition_that_was_hardly_seen_is_doubted():
    unseen = curls()
    unseen.seen[(unseen.times > 3.8) & (unseen.times < 5.6)] = False
    assert sum(one.probability > 0.5 for one in lifting(unseen, BAR)) == 2


@settings(max_examples=8, deadline=None)
@given(
    heading=st.floats(-3.0, 3.0),
    rate=st.sampled_from([10.0, 30.0, 60.0]),
    up_s=st.floats(0.5, 3.0),
    kept=st.floats(0.85, 1.0),
)
def test_neither_heading_nor_frame_rate_nor_tempo_changes_the_count(heading, rate, up_s, kept):
    whole = curls(heading=heading, rate=rate, up_s=up_s)
    some = whole[np.random.default_rng(3).random(len(whole)) < kept]
    assert len(lifting(some, BAR)) == 3


def test_a_long_bar_that_is_not_level_or_in_one_hand_is_not_lifted():
    assert all(one.probability < 0.01 for one in lifting(curls(tilt_deg=60.0), BAR))
    lifted = curls()
    lifted.joints[:, Joint.HAND_RIGHT] = np.add(lifted.positions, [0.25, 0.0, 0.0])
    lifted.joints[:, Joint.HAND_LEFT] = lifted.positions - [0.25, 0.0, 0.0]
    assert all(one.probability > 0.95 for one in lifting(lifted, BAR))
    lifted.joints[:, Joint.HAND_LEFT] = lifted.positions - [0.25, 0.0, 0.6]
    assert all(one.probability < 0.01 for one in lifting(lifted, BAR))
