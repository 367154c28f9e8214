"""Strokes of a broom whose head goes to and fro, moved by hand."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from inhand_outcomes.measures.sweeping import sweeping
from swept_by_hand import BROOM, broom


def test_counts_strokes_and_says_how_long_and_over_what_area():
    (found,) = sweeping(broom(), BROOM)
    assert found.kind == "sweeping"
    assert found.lasting
    assert found.probability > 0.95
    assert found.amounts["stroke_count"].value == 5
    # Five strokes and four ways back with their rests: 5 * 0.8 + 4 * 0.8 s.
    assert found.amounts["duration_s"].value == pytest.approx(7.2, abs=0.5)
    # A head of 0.06 by 0.30 m that goes 0.5 m square to its width.
    assert found.amounts["area_m2"].value == pytest.approx(0.30 * 0.56, rel=0.15)


def test_both_ways_count_where_the_head_stays_on_the_floor():
    (found,) = sweeping(broom(lift=0.0), BROOM)
    assert found.amounts["stroke_count"].value == 10


def test_a_floor_that_is_2_cm_off_changes_no_count():
    for base in (-0.02, 0.02):
        (found,) = sweeping(broom(base=base), BROOM)
        assert found.amounts["stroke_count"].value == 5


def test_a_broom_that_is_carried_leans_or_was_not_seen_sweeps_nothing():
    assert sweeping(broom(base=0.3), BROOM) == []
    assert sweeping(broom(strokes=0), BROOM) == []
    unseen = broom()
    unseen.seen[:] = False
    assert sweeping(unseen, BROOM) == []


def test_sweeping_is_under_way_until_no_stroke_follows():
    whole = broom()
    cut = whole[whole.times < 5.0]
    (found,) = sweeping(cut, BROOM)
    assert found.end_s == cut.times[-1]
    (ended,) = sweeping(whole, BROOM)
    assert ended.end_s == pytest.approx(1.0 + 4 * 1.6 + 0.8, abs=0.25)


@settings(max_examples=8, deadline=None)
@given(
    turn=st.floats(-3.0, 3.0),
    rate=st.sampled_from([15.0, 30.0, 60.0]),
    shift=st.floats(-1e3, 1e3),
    dropped=st.integers(0, 1000),
)
def test_neither_heading_nor_frame_rate_nor_dropped_frames_change_the_count(
    turn, rate, shift, dropped
):
    whole = broom(turn=turn, rate=rate, strokes=4)
    kept = np.random.default_rng(dropped).random(len(whole)) > 0.1
    some = whole[kept]
    object.__setattr__(some, "times", some.times + shift)
    (found,) = sweeping(some, BROOM)
    assert found.amounts["stroke_count"].value == 4
