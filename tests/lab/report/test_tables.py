"""The tables of an evaluation, as terminals and Markdown show them."""

from inhand_lab.evaluation.lost_tracks import Recoveries
from inhand_lab.evaluation.protocol import Candidate, Trial
from inhand_lab.evaluation.scoring import Score
from inhand_lab.evaluation.summary import summarise
from inhand_lab.report.tables import error_grid, measures_grid, worth_grid
from rich.console import Console

METHODS = ("g-hand", "gd-hand", "gd-random", "gd-stable", "gd-stable-proximate")
NONE = Recoveries(0, 0.0)


def trial(error_cm: float, participant: str, method: str) -> Trial:
    score = Score(100, error_cm / 100.0, 0.05, 0.2, 0.5, 0.25, 0.1, NONE, NONE)
    return Trial(Candidate(method), "putOnGlasses", participant, "one", score)


def printed(grid: object, width: int = 80) -> list[str]:
    console = Console(width=width, color_system=None)
    with console.capture() as capture:
        console.print(grid)
    return capture.get().splitlines()


COMPARED = ("fusion", *METHODS)


def test_the_methods_that_are_usually_compared_fit_into_80_columns_with_their_whole_names() -> None:
    trials = [trial(100.5, "a", name) for name in COMPARED]
    summary = summarise([*trials, *(trial(141.0, "b", name) for name in COMPARED)])
    for grid in (error_grid(summary), measures_grid(summary)):
        lines = printed(grid.for_terminal())
        assert max(map(len, lines)) <= 80
        text = "\n".join(lines)
        assert "…" not in text
        assert all(name in text for name in COMPARED[:5])
        assert "gd-stable-" in text
        assert "proximate" in text
    assert any(line.startswith("paper's mean") and "12.6" in line for line in lines_of(summary))


def lines_of(summary: dict[str, object]) -> list[str]:
    return printed(error_grid(summary).for_terminal())


def test_the_papers_worth_of_edges_stands_beside_ours() -> None:
    worths = {"none": {"interactions": {"sweepFloor": 1.25, "wave": -3.0}, "mean": -0.9}}
    lines = worth_grid("edges", worths).for_markdown().splitlines()
    assert "| sweepFloor | +1.2 | -4.3 |" in lines
    assert "| wave | -3.0 | – |" in lines
    assert lines[-1] == "| **mean** | **-0.9** | **+2.1** |"
