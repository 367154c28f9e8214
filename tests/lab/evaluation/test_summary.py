"""From trials to a table's figures."""

import dataclasses

import numpy as np
import pytest
from inhand_lab.evaluation.lost_tracks import Recoveries
from inhand_lab.evaluation.protocol import Candidate, Terms, Trial
from inhand_lab.evaluation.scoring import Score
from inhand_lab.evaluation.summary import summarise, terms_name, with_terms, worth
from inhand_lab.report.tables import error_grid, measures_grid, worth_grid
from rich.console import Console

NONE = Recoveries(0, 0.0)
SCORE = Score(100, 0.10, 0.05, np.radians(10.0), 0.5, 0.25, 0.1, NONE, NONE)
METHODS = ("g-hand", "gd-hand", "gd-random", "gd-stable", "gd-stable-proximate")


def trial(
    error_cm: float,
    participant: str = "a",
    recording: str = "one",
    *,
    method: str = "gd-stable-proximate",
    interaction: str = "wave",
    terms: Terms = ("edges",),
    seed: int = 0,
    recoveries: Recoveries = NONE,
) -> Trial:
    score = dataclasses.replace(SCORE, vertex_error_m=error_cm / 100.0, recoveries=recoveries)
    return Trial(Candidate(method, terms, seed), interaction, participant, recording, score)


def test_a_cell_is_mean_and_deviation_over_participants_and_a_row_the_mean_of_cells() -> None:
    summary = summarise(
        [
            trial(10.0, "a", "a1"),
            trial(14.0, "a", "a1", seed=1),
            trial(16.0, "b", "b1"),
            trial(16.0, "b", "b2"),
            trial(4.0, "a", "s1", interaction="sweep"),
            trial(6.0, "b", "s2", interaction="sweep"),
        ]
    )["gd-stable-proximate"]
    assert summary["interactions"]["wave"]["vertex_error_cm"] == pytest.approx(14.0)
    assert summary["interactions"]["wave"]["sd"] == pytest.approx(2.0)
    assert summary["interactions"]["sweep"]["vertex_error_cm"] == pytest.approx(5.0)
    assert summary["vertex_error_cm"] == pytest.approx(9.5)
    assert summary["sd"] == pytest.approx(1.5)
    assert summary["interactions"]["wave"]["rotation_deg"] == pytest.approx(10.0)
    assert summary["interactions"]["wave"]["translation_cm"] == pytest.approx(5.0)
    assert summary["within_5cm_5deg_percent"] == pytest.approx(50.0)


def test_of_one_participant_the_deviation_is_over_recordings() -> None:
    summary = summarise(
        [trial(10.0, "a", "a1"), trial(12.0, "a", "a1", seed=1), trial(15.0, "a", "a2")]
    )
    cell = summary["gd-stable-proximate"]["interactions"]["wave"]
    assert (cell["vertex_error_cm"], cell["sd"]) == (pytest.approx(13.0), pytest.approx(2.0))


def test_recovery_is_the_mean_over_all_losses_and_none_without_any() -> None:
    trials = [trial(9.0, "a", recoveries=Recoveries(3, 1.0)), trial(9.0, "b"), trial(9.0, "c")]
    assert summarise(trials)["gd-stable-proximate"]["recovery_s"] == pytest.approx(1.0 / 3.0)
    assert summarise(trials[1:])["gd-stable-proximate"]["recovery_s"] is None


def test_ratios_are_to_the_last_of_the_papers_methods_and_the_paper_stands_beside() -> None:
    summary = summarise([trial(20.0, method="g-hand"), trial(10.0)])
    assert summary["g-hand"]["ratio"] == pytest.approx(2.0)
    assert summary["g-hand"]["paper_cm"] == 22.1
    assert summarise([trial(20.0, method="g-hand")])["g-hand"]["ratio"] is None


def test_the_worth_of_a_term_is_over_all_methods_and_may_be_a_loss() -> None:
    trials = [
        trial(10.0, method="g-hand"),
        trial(8.0),
        trial(11.0, method="g-hand", terms=()),
        trial(9.0, terms=()),
        trial(11.0, interaction="sweep"),
        trial(10.0, interaction="sweep", terms=()),
    ]
    told = worth(trials, ("edges",), ())
    assert told["interactions"] == {"wave": pytest.approx(10.0), "sweep": pytest.approx(-10.0)}
    assert told["mean"] == pytest.approx(0.0)
    assert len(with_terms(trials, ())) == 3


@pytest.mark.parametrize(
    ("terms", "name"), [((), "none"), (("edges",), "edges"), (("edges", "depth"), "edges+depth")]
)
def test_terms_have_names(terms: Terms, name: str) -> None:
    assert terms_name(terms) == name


def printed(grid: object, width: int = 80) -> list[str]:
    console = Console(width=width, color_system=None)
    with console.capture() as capture:
        console.print(grid)
    return capture.get().splitlines()


COMPARED = ("fusion", *METHODS)


def test_the_methods_that_are_usually_compared_fit_into_80_columns_with_their_whole_names() -> None:
    trials = [trial(100.5, method=name, interaction="putOnGlasses") for name in COMPARED]
    summary = summarise([*trials, *(trial(141.0, "b", method=name) for name in COMPARED)])
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
    told = {"none": {"interactions": {"sweepFloor": 1.25, "wave": -3.0}, "mean": -0.9}}
    lines = worth_grid("edges", told).for_markdown().splitlines()
    assert "| sweepFloor | +1.2 | -4.3 |" in lines
    assert "| wave | -3.0 | – |" in lines
    assert lines[-1] == "| **mean** | **-0.9** | **+2.1** |"
