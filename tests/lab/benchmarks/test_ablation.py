"""What each part of fusion is worth, on a dataset of three people."""

import json
from pathlib import Path

import pytest
from inhand_lab.benchmarks.ablation import variants_for
from inhand_lab.benchmarks.ablation_data import AblationData
from inhand_lab.datasets.dataset import load_dataset
from waving import write_dataset

from inhand.__main__ import main

pytestmark = pytest.mark.long


def test_other_values_of_parameters_stand_beside_the_whole(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_dataset(tmp_path / "data", frames=20, images=True)
    written = tmp_path / "worths.json"
    varied = ["--vary", "refines=false", "--vary", "image_temper=0.1"]
    command = ["bench", "ablation", str(tmp_path / "data"), *varied, "--json", str(written)]
    assert main(command) == 0
    whole, *others = json.loads(written.read_text())["variants"]
    assert whole["without"] == "nothing"
    assert [(row["part"], row["without"], row["instead"]) for row in others] == [
        ("parameter", "refines=true", "refines=false"),
        ("parameter", "image_temper=0.8", "image_temper=0.1"),
    ]
    assert len({row["vertex_error_cm"] for row in (whole, *others)}) == 3
    assert "image_temper=0.8 (instead 0.1)" in " ".join(capsys.readouterr().out.split())


@pytest.mark.exhaustive
def test_every_part_is_taken_out_once_and_the_table_shows_what_that_costs(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_dataset(tmp_path / "data", frames=20, images=True)
    written = tmp_path / "worths.json"
    assert main(["bench", "ablation", str(tmp_path / "data"), "--json", str(written)]) == 0
    rows = json.loads(written.read_text())["variants"]
    assert [(row["part"], row["without"]) for row in rows] == [
        (one.part, one.without)
        for one in variants_for(AblationData(load_dataset(tmp_path / "data")))
    ]
    errors = {row["without"]: row["vertex_error_cm"] for row in rows}
    assert 0.0 < errors["nothing"] < 10.0
    assert len(set(errors.values())) > len(errors) // 2
    assert errors["all anchors but the trunk"] > errors["nothing"]
    shown = capsys.readouterr().out
    assert f"{errors['nothing']:.2f}" in shown
    assert "refinement" in shown


def test_on_other_people_without_images_what_makes_it_true_for_them_is_taken_out(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folders = [tmp_path / name for name in ("people", "others", "plain")]
    for folder in folders:
        write_dataset(folder, frames=20)
    people, others, plain = map(str, folders)
    written = tmp_path / "worths.json"
    command = ["bench", "ablation", people, "--test-on", others, "--plain", plain, "--no-images"]
    assert main([*command, "--json", str(written)]) == 0
    rows = json.loads(written.read_text())["variants"]
    assert {row["part"] for row in rows} == {"", "prior", "transfer"}
    assert [row["without"] for row in rows[-2:]] == ["the canonical body", "people's variety"]
    assert all(0.0 <= row["within_90_percent_region_percent"] <= 100.0 for row in rows)
    assert "region, %" in " ".join(capsys.readouterr().out.split())


def test_plain_people_stand_for_those_who_teach_about_others(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["bench", "ablation", str(tmp_path), "--plain", str(tmp_path)]) == 2
    assert "--test-on" in capsys.readouterr().err
