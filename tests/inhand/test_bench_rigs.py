"""The table of what several cameras are worth together."""

from dataclasses import replace

import pytest
from inhand_lab.benchmarks.rig_accuracy import RigCheck
from rich.console import Console

from inhand.__main__ import main
from inhand.bench_rigs import rigs_table

MUG = RigCheck(
    "drinkFromMug", 6001, {"front": 0.02, "left": 0.04}, 0.01, 100, 1, "left", 0.015, 2,
    0.012, 0.008, 0.92, 3.0, 5.4,
)  # fmt: skip


def test_errors_stand_beside_the_best_and_the_mean_camera_s() -> None:
    console = Console(width=200, record=True)
    worse = replace(MUG, interaction="answerPhone", fused_m=0.02, jump_m=0.03, without_pose=0)
    console.print(rigs_table([MUG, worse]))
    rows = [line.replace("│", " ").split() for line in console.export_text().splitlines()]
    mug = next(row for row in rows if "drinkFromMug" in row)
    assert mug[2:9] == ["2.00", "4.00", "2.00", "3.00", "1.00", "0.50", "0.33"]
    whole = next(row for row in rows if row and row[0] == "all" and "%" in row)
    assert whole[3:8] == ["2.00", "3.00", "1.50", "0.75", "0.50"]
    assert whole[8:11] == ["0.50", "%", "3.0"]


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (["--cameras", "5"], "--cameras is from 2 to 4, not 5"),
        (["--interactions", "hammerNail"], "hammerNail"),
        (["--placed-off-mm", "-1"], "--placed-off-mm and --placed-off-deg are 0 or more"),
        (["--placed-off-deg", "nan"], "--placed-off-mm and --placed-off-deg are 0 or more"),
    ],
)
def test_what_cannot_be_simulated_is_refused(
    arguments: list[str], reason: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["bench", "rigs", *arguments]) == 2
    assert reason in capsys.readouterr().err


def test_a_seed_below_0_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["bench", "rigs", "--seeds", "1", "-1"])
    assert "write a whole number, 0 or more, not '-1'" in capsys.readouterr().err
