"""Where the likelihood's optimum is, on rendered frames."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from inhand_lab.benchmarks.likelihood_bias import Bias, measure_bias
from inhand_lab.benchmarks.parameters import DEFAULT_LIKELIHOOD_BIAS

from inhand.__main__ import main

FEW = replace(DEFAULT_LIKELIHOOD_BIAS, rooms=1, learned=6, poses=8, starts=2, distance_m=(1.5, 2.5))


@pytest.mark.long
def test_a_mug_that_returns_depth_is_found_to_a_millimetre_across_and_five_along() -> None:
    steps: list[None] = []
    (mug,) = measure_bias(["drinkFromMug"], lambda: steps.append(None), FEW)
    assert (mug.name, mug.poses, len(steps)) == ("mug", 8, 1)
    assert set(mug.terms) == {"edges", "region", "interior", "depth"}
    assert mug.refined.across_mm < 1.0
    assert abs(mug.refined.along_mm) < 5.0
    assert abs(mug.terms["depth"].along_mm) < 5.0


def test_across_is_how_far_it_lies_both_ways() -> None:
    assert Bias(3.0, -4.0, 9.0).across_mm == pytest.approx(5.0)


@pytest.mark.long
def test_the_verb_writes_what_it_shows(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    quick = replace(FEW, learned=3, poses=2, starts=1)
    monkeypatch.setattr(
        "inhand.bench.measure_bias",
        lambda _, advance: measure_bias(["drinkFromMug"], advance, quick),
    )
    assert main(["bench", "likelihood", "--json", str(tmp_path / "out.json")]) == 0
    (mug,) = json.loads((tmp_path / "out.json").read_text())["objects"]
    assert mug["name"] == "mug"
    assert set(mug["refined"]) == {"right_mm", "down_mm", "along_mm"}
    assert "mug" in capsys.readouterr().out
