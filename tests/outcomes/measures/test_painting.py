"""Strokes of a brush on an upright wall, with a way to a pot in between."""

import numpy as np
import pytest
from hand_made import moved, thing, track
from hypothesis import given, settings
from hypothesis import strategies as st
from inhand_outcomes.measures.painting import painting
from scipy.spatial.transform import Rotation

BRUSH = thing(
    "brush",
    ([-0.035, -0.005, -0.08], [0.035, 0.005, 0.0]),
    ([-0.01, -0.01, 0.0], [0.01, 0.01, 0.16]),
)
WALL_M = 2.0
TIPS = np.array([0.0, 0.0, -0.08])


def brush(*, strokes=4, bouts=2, off_m=0.0, heading=0.0, rate=30.0, seed=0):
    """Bouts of strokes 0.4 m up and down, 0.7 s each and 5 cm apart; 2.6 s to a pot and back.

    The brush points into the wall at y = 2 m, or leaves it by ``off_m`` from stroke to stroke.
    """
    pot, keys = (0.5, 1.6, 0.8), [(0.0, (0.5, 1.6, 0.95)), (0.6, (0.5, 1.6, 0.95))]
    now, aside = 0.6, -0.4
    for _ in range(bouts):
        now += 0.8
        height, way = 1.5, -1.0
        keys.append((now, (aside, WALL_M, height)))
        for number in range(strokes):
            now += 0.7
            height += 0.4 * way
            way = -way
            aside += 0.05
            keys.append((now, (aside, WALL_M - off_m * (number % 2), height)))
        now += 0.8
        keys += [(now, (pot[0], pot[1], 0.95)), (now + 0.5, pot), (now + 1.0, (*pot[:2], 0.95))]
        now += 1.0
    times = np.arange(0.0, now + 5.0, 1.0 / rate)
    tips = moved(times, keys)
    around = Rotation.from_euler("z", heading)
    # Bristles (-z of the brush) point into the wall (+y), the wide side (x) along it.
    pointing = around * Rotation.from_euler("x", 90.0, degrees=True)
    noise = np.random.default_rng(seed).normal(0.0, 0.003, tips.shape)
    positions = around.apply(tips + noise) - pointing.apply(TIPS)
    return track(times, positions, Rotation.concatenate([pointing] * len(times)))


def test_says_for_how_long_and_over_what_area_dips_being_part_of_it():
    (found,) = painting(brush(), BRUSH)
    assert found.lasting
    assert found.probability > 0.9
    assert found.amounts["stroke_count"].value == 8
    # Twice four strokes of 0.7 s, and 0.8 + 1.0 + 0.8 s to the pot and back.
    assert found.amounts["duration_s"].value == pytest.approx(8.2, abs=0.5)
    # Eight strokes 5 cm apart that lean by 5 cm: a parallelogram about 8 * 5 + 7 - 5 cm wide.
    assert found.amounts["area_m2"].value == pytest.approx(0.40 * 0.44, rel=0.15)


def test_a_brush_that_is_waved_before_a_wall_paints_nothing():
    assert painting(brush(off_m=0.3), BRUSH) == []
    assert painting(brush(bouts=0), BRUSH) == []
    unseen = brush()
    unseen.seen[:] = False
    assert painting(unseen, BRUSH) == []


def test_painting_is_under_way_until_the_brush_stays_away():
    whole = brush()
    cut = whole[whole.times < 5.0]
    (found,) = painting(cut, BRUSH)
    assert found.end_s == cut.times[-1]
    (ended,) = painting(whole, BRUSH)
    assert ended.end_s < whole.times[-1] - 4.5


@settings(max_examples=6, deadline=None)
@given(heading=st.floats(-3.0, 3.0), rate=st.sampled_from([15.0, 30.0, 60.0]))
def test_neither_the_wall_s_heading_nor_the_frame_rate_changes_what_is_painted(heading, rate):
    (found,) = painting(brush(heading=heading, rate=rate), BRUSH)
    assert found.amounts["stroke_count"].value == 8
    assert found.amounts["area_m2"].value == pytest.approx(0.176, rel=0.2)
