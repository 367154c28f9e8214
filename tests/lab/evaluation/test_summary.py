"""From trials to a table's figures."""

import dataclasses

import numpy as np
import pytest
from inhand_lab.evaluation.lost_tracks import Recoveries
from inhand_lab.evaluation.protocol import Candidate, Terms, Trial
from inhand_lab.evaluation.scoring import Score
from inhand_lab.evaluation.summary import summarise, terms_name, with_terms, worth

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


def test_how_stated_deviations_rank_errors_is_seen_over_frames_of_all_interactions() -> None:
    def stating(pairs: tuple[tuple[float, float], ...], interaction: str) -> Trial:
        one = trial(10.0, interaction=interaction)
        return dataclasses.replace(one, score=dataclasses.replace(one.score, stated=pairs))

    small, large = ((0.02, 0.03), (0.03, 0.01)), ((0.2, 0.3), (0.3, 0.1))
    summary = summarise([stating(small, "wave"), stating(large, "sweep")])["gd-stable-proximate"]
    assert summary["interactions"]["wave"]["stated_rank_correlation"] == pytest.approx(-1.0)
    assert summary["stated_rank_correlation"] == pytest.approx(0.6)
    assert summarise([trial(10.0)])["gd-stable-proximate"]["stated_rank_correlation"] is None
