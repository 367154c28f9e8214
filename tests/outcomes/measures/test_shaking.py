"""Shakes of a bottle that is tipped and goes to and fro along its axis as a sine does."""

import numpy as np
import pytest
from hand_made import moved, thing, track
from hypothesis import given, settings
from hypothesis import strategies as st
from inhand_outcomes.measures.shaking import shaking
from scipy.spatial.transform import Rotation

BOTTLE = thing("bottle", ([-0.03, -0.03, -0.1], [0.03, 0.03, 0.1]))


def bottle(*, tilt_deg=120.0, half_m=0.02, per_s=3.5, rate=30.0, turn=0.0, bouts=2, seed=0):
    """Bouts of 5 strokes from 1.5 s on, 1.5 s of rest between them; tipped from 0.5 to 1.2 s."""
    bout_s = 5.0 / per_s
    times = np.arange(0.0, 2.0 + bouts * (bout_s + 1.5), 1.0 / rate)
    along = np.zeros(len(times))
    for number in range(bouts):
        since = times - 1.5 - number * (bout_s + 1.5)
        inside = (since >= 0.0) & (since < bout_s)
        # Begins and ends at rest at the far turn, so that there are five whole strokes.
        along += np.where(inside, half_m * (1.0 - np.cos(2.0 * np.pi * per_s * since)), 0.0)
    tilts = np.radians(moved(times, [(0.5, 0.0), (1.2, tilt_deg)]))
    rotations = Rotation.from_euler("z", turn) * Rotation.from_euler("x", tilts)
    noise = np.random.default_rng(seed).normal(0.0, 0.0015, (len(times), 3))
    positions = rotations.apply([0.0, 0.0, 1.0]) * along[:, None] + [0.2, 1.5, 1.1] + noise
    return track(times, positions, rotations)


def surely(found):
    return [one for one in found if one.probability > 0.5]


def test_counts_bouts_and_their_strokes():
    found = surely(shaking(bottle(), BOTTLE))
    assert [one.kind for one in found] == ["shake", "shake"]
    assert [one.amounts["stroke_count"].value for one in found] == [5.0, 5.0]
    assert found[0].amounts["rate_per_s"].value == pytest.approx(3.5, rel=0.1)
    assert found[0].start_s == pytest.approx(1.5, abs=0.15)


def test_a_bottle_that_is_mixed_upright_carried_or_trembles_is_not_shaken_out():
    assert surely(shaking(bottle(tilt_deg=20.0), BOTTLE)) == []
    assert surely(shaking(bottle(per_s=0.6, half_m=0.1), BOTTLE)) == []
    assert surely(shaking(bottle(half_m=0.003, per_s=6.0), BOTTLE)) == []


def test_what_was_not_seen_is_no_shake():
    unseen = bottle()
    unseen.seen[(unseen.times > 1.5) & (unseen.times < 3.0)] = False
    assert len(surely(shaking(unseen, BOTTLE))) == 1


@settings(max_examples=8, deadline=None)
@given(
    turn=st.floats(-3.0, 3.0), rate=st.sampled_from([25.0, 30.0, 60.0]), per_s=st.floats(2.5, 4.0)
)
def test_neither_heading_nor_frame_rate_nor_pace_changes_the_count(turn, rate, per_s):
    found = surely(shaking(bottle(turn=turn, rate=rate, per_s=per_s), BOTTLE))
    assert [one.amounts["stroke_count"].value for one in found] == [5.0, 5.0]
