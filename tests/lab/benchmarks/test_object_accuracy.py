"""The table of new objects beside the true ones."""

import json
from pathlib import Path

import numpy as np
import pytest
from inhand_lab.benchmarks.object_accuracy import check_objects, object_steps, true_objects
from inhand_lab.benchmarks.parameters import ObjectAccuracyParameters

from inhand import bench
from inhand.__main__ import main

FEW = ObjectAccuracyParameters(scenes=2, frames=6, compared=1000)


@pytest.mark.long
def test_measures_and_the_camera_come_to_millimetres_and_a_hammer_is_refused() -> None:
    advanced: list[None] = []
    checks = {check.name: check for check in check_objects(lambda: advanced.append(None), FEW)}
    assert list(checks) == ["mug", "vinegar_bottle", "box", "hammer"]
    assert len(advanced) == object_steps(FEW)
    assert all(0.0 < check.by_measures_mm < 4.0 for check in checks.values())
    assert all(len(c.by_camera_mm) + len(c.refusals) == FEW.scenes for c in checks.values())
    assert checks["hammer"].by_camera_mm == ()
    for name in ("mug", "vinegar_bottle", "box"):
        assert checks[name].camera_median_mm < 6.0


def test_the_measures_that_a_ruler_reads_are_those_of_the_true_meshes() -> None:
    for true in true_objects():
        height = true.measures_cm.get("height", true.measures_cm.get("length"))
        assert height is not None
        assert 100.0 * np.ptp(true.model.vertices[:, 2]) == pytest.approx(height, abs=0.06)


@pytest.mark.long
def test_the_table_is_shown_and_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    few = ObjectAccuracyParameters(scenes=1, frames=3, compared=200, samples=5000)
    monkeypatch.setattr(bench, "check_objects", lambda advance: check_objects(advance, few))
    assert main(["bench", "objects", "--json", str(tmp_path / "a.json")]) == 0
    rows = json.loads((tmp_path / "a.json").read_text())["objects"]
    assert [row["name"] for row in rows] == ["mug", "vinegar_bottle", "box", "hammer"]
    assert "mean surface distance" in capsys.readouterr().out
