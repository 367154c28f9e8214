"""Golf and tennis of real people: one stroke a recording, at the speed that was measured."""

import pytest
from real_data import DATA, needs_real_data

from inhand.outcomes_on_real_data import golf_swings, tennis_strokes


@needs_real_data
def test_finds_each_golf_swing_at_about_the_measured_speed_of_the_head():
    swings = golf_swings(DATA / "motion")
    assert len(swings) == 5
    for swing in swings:
        assert swing.swings == 1
        assert swing.speed_m_s == pytest.approx(swing.measured_m_s, rel=0.15)
        # Players swing irons and woods in planes of 45 to 65 degrees, taller ones more.
        assert 40.0 < swing.angle_deg < 75.0


@needs_real_data
def test_counts_one_stroke_in_nearly_every_recording_of_mimed_tennis():
    strokes = [one.strokes for one in tennis_strokes(DATA / "utd-mhad")]
    assert len(strokes) == 64
    assert sum(count == 1 for count in strokes) >= 60
    assert all(1 <= count <= 2 for count in strokes)
