"""Means of trials of recognition, by hand."""

from dataclasses import replace

import pytest
from inhand_lab.recognition.recognition_protocol import RecognitionTrial
from inhand_lab.recognition.recognition_scores import RecognitionScore
from inhand_lab.recognition.recognition_summary import PAPER_PERSON_PIXELS, summarise_recognition
from inhand_lab.recognition.recognition_tables import light_grid, recognition_grids

TRIALS = [
    RecognitionTrial(
        "cascade", "sweepFloor", "a", 200.0, RecognitionScore(10, 3.0, 0.8, 0.5, 0.02)
    ),
    RecognitionTrial("cascade", "sweepFloor", "b", 200.0, RecognitionScore(10, 5.0, 0.6)),
    RecognitionTrial("cascade", "hammerNail", "a", 200.0, RecognitionScore(10, 9.0, 1.0, 1.0)),
    RecognitionTrial("MIL", "sweepFloor", "a", 200.0, RecognitionScore(10, 6.0)),
    RecognitionTrial("MIL", "hammerNail", "a", 200.0, RecognitionScore(10, 7.0)),
]


def test_pixels_are_those_at_the_paper_s_person_and_what_is_missing_does_not_count() -> None:
    sweep = summarise_recognition(TRIALS)["methods"]["cascade"]["interactions"]["sweepFloor"]
    assert sweep["box_error_pixels"] == pytest.approx(4.0 * PAPER_PERSON_PIXELS / 200.0)
    assert sweep["known_percent"] == pytest.approx(70.0)
    assert sweep["precision_percent"] == pytest.approx(50.0)
    assert sweep["vertex_error_cm"] == pytest.approx(2.0)


def test_a_cascade_is_better_in_the_interactions_where_its_boxes_are_nearer() -> None:
    assert summarise_recognition(TRIALS)["better_in"] == {"cascade": {"MIL": 1}}


def test_tables_show_every_method_s_boxes_and_the_cascades_other_measures() -> None:
    errors, measures = recognition_grids(summarise_recognition(TRIALS))
    assert errors.header == ("interaction", "cascade", "MIL", "P12", "P12's adaptive")
    assert errors.rows[0] == ("sweepFloor", "8.0 (50)", "12.0", "33 (96)", "175")
    assert measures.header == ("measure", "cascade")
    assert [row[0] for row in measures.rows][:2] == ["box error, pixels", "known, % of frames"]


def test_how_often_the_right_object_is_known_stands_for_each_light() -> None:
    other = [replace(TRIALS[2], score=RecognitionScore(10, 9.0, 0.8, 0.25))]
    results = {"as recorded": summarise_recognition(TRIALS), "blue": summarise_recognition(other)}
    grid = light_grid({"as recorded": summarise_recognition(TRIALS[2:3]), "blue": results["blue"]})
    assert grid.header == ("interaction", "cascade, as recorded", "cascade, blue")
    assert grid.rows == (("hammerNail", "100.0", "20.0"),)
    assert grid.summary == (("mean", "100.0", "20.0"),)
    sweep = results["as recorded"]["methods"]["cascade"]["interactions"]["sweepFloor"]
    assert sweep["right_percent"] == pytest.approx(20.0)


def test_who_knows_no_object_is_never_right() -> None:
    assert RecognitionScore(10, 5.0, 0.6).right_share == 0.0
    assert RecognitionScore(10, 5.0).right_share is None
