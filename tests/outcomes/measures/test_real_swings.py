"""Golf and tennis of real people: one stroke a recording, at the speed that was measured."""

import json

import numpy as np
import pytest
from real_data import DATA, needs_real_data

from inhand.__main__ import main


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    """What the command finds in the real data."""
    result = tmp_path_factory.mktemp("real") / "result.json"
    folders = [str(DATA / name) for name in ("motion", "utd-mhad")]
    assert main(["bench", "outcomes", "--real", *folders, "--json", str(result)]) == 0
    return json.loads(result.read_text())["real"]


@needs_real_data
def test_finds_each_golf_swing_at_about_the_measured_speed_of_the_head(found):
    assert len(found["golf"]) == 5
    off = []
    for swing in found["golf"]:
        assert swing["swings"] == [1] * 8
        off.append(np.array(swing["speeds_m_s"]) / swing["measured_m_s"] - 1.0)
        # Players swing irons and woods in planes of 45 to 65 degrees, taller ones more.
        assert all(40.0 < angle < 75.0 for angle in swing["angles_deg"])
    # At the ball the head loses a third of its speed within a frame.
    assert np.mean(off) == pytest.approx(-0.06, abs=0.02)
    assert np.abs(off).max() < 0.13


@needs_real_data
def test_counts_one_stroke_in_nearly_every_recording_of_mimed_tennis(found):
    strokes = [one["strokes"] for one in found["tennis"]]
    assert len(strokes) == 64
    assert sum(count == 1 for count in strokes) >= 60
    assert all(1 <= count <= 2 for count in strokes)


def test_a_folder_without_swings_is_refused(tmp_path, capsys):
    assert main(["bench", "outcomes", "--real", str(tmp_path)]) == 2
    assert "no motion archive of a golf swing" in capsys.readouterr().err


def test_estimated_skeletons_need_simulated_people(tmp_path, capsys):
    assert main(["bench", "outcomes", "--estimated", "--real", str(tmp_path)]) == 2
    assert "--estimated is measured on a SOURCE" in capsys.readouterr().err
