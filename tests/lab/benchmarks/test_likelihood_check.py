"""The likelihood on real frames."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from inhand_lab.benchmarks.likelihood_check import check_likelihood
from inhand_lab.benchmarks.parameters import DEFAULT_LIKELIHOOD_CHECK
from inhand_lab.datasets.dataset import DatasetError
from real_data import DATA, needs_real_data

from inhand.__main__ import main

YCB = DATA / "ycb-video"


@needs_real_data
@pytest.mark.long
@pytest.mark.exhaustive
def test_real_objects_are_found_to_millimetres_and_the_truth_ranks_high() -> None:
    checks = check_likelihood(YCB, replace(DEFAULT_LIKELIHOOD_CHECK, starts=6, scattered=3000))
    assert {check.shape for check in checks} == {"box", "cup"}
    assert len(checks) == 3
    for check in checks:
        assert check.frames == 10
        assert check.translation_mm < 5.0
        assert check.rotation_deg < 2.5
        assert check.worst_rank < 0.01


@needs_real_data
def test_the_verb_writes_what_it_shows(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    quick = replace(DEFAULT_LIKELIHOOD_CHECK, starts=1, scattered=10)
    monkeypatch.setattr(
        "inhand.bench.check_likelihood", lambda source: check_likelihood(source, quick)
    )
    assert main(["bench", "likelihood", str(YCB), "--json", str(tmp_path / "out.json")]) == 0
    objects = json.loads((tmp_path / "out.json").read_text())["objects"]
    assert [one["name"] for one in objects] == ["009_gelatin_box", "025_mug", "061_foam_brick"]
    assert all(one["frames"] == 10 for one in objects)


def test_a_folder_without_frames_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DatasetError, match="name the folder of YCB-Video"):
        check_likelihood(tmp_path)


@pytest.mark.parametrize("words", [["labels"], ["tracker", "somewhere"]])
def test_a_source_is_for_what_is_measured_on_one(
    words: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["bench", *words]) == 2
    assert "SOURCE" in capsys.readouterr().err
