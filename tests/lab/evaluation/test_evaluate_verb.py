"""``inhand evaluate`` as people and scripts use it."""

import json
from pathlib import Path

import pytest
from waving import write_dataset

from inhand.__main__ import main


def test_the_command_writes_what_the_contract_says(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_dataset(tmp_path / "set", frames=20)
    file = tmp_path / "result.json"
    arguments = ["--no-images", "--seeds", "2", "--json", str(file)]
    assert main(["evaluate", str(tmp_path / "set"), *arguments]) == 0
    result = json.loads(file.read_text())
    assert list(result["methods"]) == [
        "fusion",
        "g-hand",
        "gd-hand",
        "gd-random",
        "gd-stable",
        "gd-stable-proximate",
    ]
    assert result["frames"] == 6 * 2 * 3 * 20
    assert result["seconds"] > 0.0
    for method in result["methods"].values():
        assert {"vertex_error_cm", "sd"} <= set(method)
        assert {
            "vertex_error_cm",
            "sd",
            "rotation_deg",
            "translation_cm",
            "recovery_s",
        } <= set(method["interactions"]["wave"])
    told = capsys.readouterr().out
    assert max(map(len, told.splitlines())) <= 80
    assert "…" not in told


@pytest.mark.long
def test_one_long_take_is_evaluated_by_its_stretches_and_says_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_dataset(tmp_path / "take", 1, frames=600)
    file = tmp_path / "result.json"
    arguments = ["--no-images", "--methods", "gd-hand", "--json", str(file)]
    assert main(["evaluate", str(tmp_path / "take"), *arguments]) == 0
    result = json.loads(file.read_text())
    assert result["frames"] == 480
    assert result["methods"]["gd-hand"]["interactions"]["wave"]["sd"] > 0.0
    (note,) = result["notes"]
    assert "one person (p0) in one take" in note
    assert note in " ".join(capsys.readouterr().out.split())


def test_testing_on_another_set_learns_from_the_first(tmp_path: Path) -> None:
    write_dataset(tmp_path / "a", frames=20)
    write_dataset(tmp_path / "b", 1, frames=20, first=9)
    file = tmp_path / "result.json"
    arguments = ["--test-on", str(tmp_path / "b"), "--no-images", "--methods", "gd-hand"]
    assert main(["evaluate", str(tmp_path / "a"), *arguments, "--json", str(file)]) == 0
    assert json.loads(file.read_text())["frames"] == 20


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["--methods", "juggle"], "no method 'juggle'; there are: fusion, g-hand, gd-hand"),
        (
            ["--terms", "edges,smell"],
            "no term 'smell'; there are: own, none, edges, region, interior, depth",
        ),
        (["--terms", "edges,"], "no term ''; there are: own, none, edges"),
        (["--seeds", "0"], "--seeds is 1 or more"),
    ],
)
def test_wrong_usage_is_one_line_and_2(
    arguments: list[str], line: str, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    write_dataset(tmp_path, frames=2)
    assert main(["evaluate", str(tmp_path), *arguments]) == 2
    (told,) = capsys.readouterr().err.splitlines()
    assert told.startswith(f"inhand evaluate: {line}")


def test_a_report_that_cannot_be_written_is_one_line_before_anything_is_tracked(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_dataset(tmp_path / "set", frames=10)
    (tmp_path / "file").write_text("")
    arguments = ["--no-images", "--methods", "gd-hand", "--report", str(tmp_path / "file")]
    assert main(["evaluate", str(tmp_path / "set"), *arguments]) == 2
    (told,) = capsys.readouterr().err.splitlines()
    assert told.startswith(f"inhand evaluate: cannot write to {tmp_path / 'file'}")


def test_people_are_added_of_what_is_tested_on_and_of_nothing_else(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["evaluate", str(tmp_path), "--with", "s1"]) == 2
    assert "--test-on" in capsys.readouterr().err
