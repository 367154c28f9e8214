"""Strokes of a club that turns about a point at a speed that is known."""

import numpy as np
import pytest
from hand_made import moved, thing, track
from hypothesis import given, settings
from hypothesis import strategies as st
from inhand_outcomes.measures.smoothing import smooth
from inhand_outcomes.measures.swinging import GOLF, golf, head_of, head_speeds, tennis
from scipy.spatial.transform import Rotation

CLUB = thing(
    "club",
    ([-0.005, -0.005, -0.8], [0.005, 0.005, 0.1]),
    ([-0.01, -0.01, -0.82], [0.01, 0.08, -0.76]),
)
HEAD_M = 0.86
"""Distance of the club's head from the shoulders that it turns about, in the plane of the swing."""
CENTRE = np.array([0.3, 2.0, 1.4])


def swung(*, turn_s=0.4, turn_rad=5.0, plane_deg=60.0, heading=0.0, rate=30.0, back_s=1.0, seed=0):
    """A club that is drawn back in ``back_s``, swung through within ``turn_s``, and brought back.

    Moves are of least jerk: the highest speed is 15/8 of the mean.
    """
    times = np.arange(0.0, 4.0 + back_s + turn_s, 1.0 / rate)
    top, through = 1.0 + back_s, 1.2 + back_s
    keys = [(1.0, 0.0), (top, 0.5 * turn_rad), (through, 0.5 * turn_rad)]
    keys += [(through + turn_s, -0.5 * turn_rad), (through + turn_s + 0.6, -0.5 * turn_rad)]
    keys += [(through + turn_s + 1.7, 0.0)]
    angles = moved(times, keys)[:, 0]
    # The club hangs along -z and turns about y; then that plane is leant, and the whole turned.
    leaning = Rotation.from_euler("z", heading) * Rotation.from_euler(
        "x", 90.0 - plane_deg, degrees=True
    )
    rotations = leaning * Rotation.from_euler("y", angles[:, None])
    noise = np.random.default_rng(seed).normal(0.0, 0.003, (len(times), 3))
    positions = Rotation.from_euler("z", heading).apply(CENTRE) + noise
    return track(times, positions + rotations.apply([0.0, 0.0, -0.07]), rotations)


def surely(found):
    return [one for one in found if one.probability > 0.5]


def test_the_head_is_where_a_thing_is_widest():
    assert head_of(CLUB) == pytest.approx([0.0, 0.035, -0.79], abs=0.01)


def test_a_club_that_turns_evenly_about_the_shoulders_is_as_fast_as_it_is():
    times = np.arange(0.0, 1.0, 1.0 / 30.0)
    turn_s = 40.0  # radians a second: 1.3 from frame to frame
    rotations = Rotation.from_euler("y", turn_s * times[:, None])
    hands = np.array([0.0, 0.0, -0.7])
    _, speeds, _, _ = head_speeds(
        track(times, CENTRE + rotations.apply(hands), rotations), head := head_of(CLUB), GOLF
    )
    assert speeds == pytest.approx(turn_s * np.linalg.norm((head + hands)[[0, 2]]), rel=1e-6)


def test_means_over_frames_show_the_peak_of_a_parabola():
    edges = np.arange(-0.3, 0.3, 1.0 / 30.0) + 0.011
    middles, spans = 0.5 * (edges[1:] + edges[:-1]), np.diff(edges)
    means = 40.0 - 900.0 * np.diff(edges**3 / 3.0) / spans
    flags = np.ones(len(middles), bool)
    at = np.zeros(1)
    found = smooth(middles, means[:, None], flags, at, 0.08, order=2, spans_s=spans)
    assert found.values[0, 0] == pytest.approx(40.0, abs=1e-4)


@pytest.mark.parametrize("plane_deg", [45.0, 60.0, 80.0])
def test_says_the_speed_of_the_head_and_the_plane(plane_deg):
    (found,) = surely(golf(swung(turn_s=0.35, plane_deg=plane_deg), CLUB))
    highest = 15.0 / 8.0 * 5.0 / 0.35 * HEAD_M
    assert found.amounts["speed_m_s"].value == pytest.approx(highest, rel=0.06)
    assert found.amounts["angle_deg"].value == pytest.approx(plane_deg, abs=4.0)
    assert found.evidence["peak_s"] == pytest.approx(2.2 + 0.175, abs=0.05)


def test_waggles_and_the_way_back_are_no_swings():
    assert surely(golf(swung(turn_s=0.5, turn_rad=0.6), CLUB)) == []
    assert surely(golf(swung(turn_s=1.2), CLUB)) == []


def test_a_stroke_that_was_not_seen_or_is_cut_is_left_out():
    unseen = swung(turn_s=0.5)
    unseen.seen[(unseen.times > 2.1) & (unseen.times < 2.8)] = False
    assert surely(tennis(unseen, CLUB)) == []
    whole = swung(turn_s=0.5)
    assert surely(tennis(whole[whole.times < 2.4], CLUB)) == []
    assert len(surely(tennis(whole[whole.times < 3.2], CLUB))) == 1


@settings(max_examples=8, deadline=None)
@given(
    heading=st.floats(-3.0, 3.0),
    rate=st.sampled_from([25.0, 30.0, 60.0]),
    turn_s=st.floats(0.4, 0.8),
)
def test_neither_heading_nor_frame_rate_changes_count_and_speed(heading, rate, turn_s):
    (found,) = surely(tennis(swung(turn_s=turn_s, heading=heading, rate=rate), CLUB))
    highest = 15.0 / 8.0 * 5.0 / turn_s * HEAD_M
    assert found.amounts["speed_m_s"].value == pytest.approx(highest, rel=0.10)
