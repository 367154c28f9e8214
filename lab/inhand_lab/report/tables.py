"""The tables of an evaluation: vertex errors, other measures, and what terms are worth."""

from collections.abc import Mapping, Sequence
from typing import Any

from inhand_lab.evaluation.published import (
    EDGE_WORTH_PERCENT,
    MEAN_EDGE_WORTH_PERCENT,
    REFERENCE_METHOD,
    VERTEX_ERROR_CM,
)
from inhand_lab.report.grid import NOTHING, Grid

MEASURES = {
    "worst_recording_cm": "worst recording, cm",
    "rotation_deg": "rotation, °",
    "translation_cm": "translation, cm",
    "within_5cm_5deg_percent": "within 5 cm 5°, %",
    "within_90_percent_region_percent": "within its 90 % region, %",
    "stated_rank_correlation": "stated, rank of errors",
    "add_area_percent": "ADD(-S) area, %",
    "lost_percent": "lost, %",
    "recovery_s": "recovery, s",
    "body_recovery_s": "after body, s",
}


def error_grid(methods: Mapping[str, Any], remark: str = "") -> Grid:
    """Return vertex errors as the paper's Table 1, with its means below ours."""
    interactions = next(iter(methods.values()))["interactions"]
    published = [VERTEX_ERROR_CM.get(name) for name in methods]
    rows = tuple(
        (name, *(_spread(method["interactions"][name]) for method in methods.values()))
        for name in interactions
    )
    return Grid(
        f"vertex error in cm: mean ± sd over participants{remark}",
        ("interaction", *methods),
        rows,
        (
            ("mean", *(_spread(method) for method in methods.values())),
            ("paper's mean", *(_number(value) for value in published)),
            ("ratio", *(_number(method["ratio"], 2) for method in methods.values())),
            ("paper's ratio", *(_number(_published_ratio(value), 2) for value in published)),
        ),
    )


def measures_grid(methods: Mapping[str, Any]) -> Grid:
    """Return the other measures, means over interactions."""
    rows = tuple(
        (title, *(_number(method[key], _digits(key)) for method in methods.values()))
        for key, title in MEASURES.items()
    )
    return Grid("means over interactions", ("measure", *methods), rows)


def interaction_grid(measure: str, methods: Mapping[str, Any]) -> Grid:
    """Return one of the other measures for every interaction."""
    interactions, digits = next(iter(methods.values()))["interactions"], _digits(measure)
    rows = tuple(
        (name, *(_number(one["interactions"][name][measure], digits) for one in methods.values()))
        for name in interactions
    )
    mean = ("mean", *(_number(method[measure], digits) for method in methods.values()))
    return Grid(MEASURES[measure], ("interaction", *methods), rows, (mean,))


def worth_grid(terms: str, worths: Mapping[str, Any]) -> Grid:
    """Return by how much terms reduce the vertex error; ``worths`` by the names of other terms."""
    interactions = next(iter(worths.values()))["interactions"]
    against = tuple(f"against {name}" for name in worths)
    paper = "paper, edges"
    rows = tuple(
        (
            name,
            *(f"{worth['interactions'][name]:+.1f}" for worth in worths.values()),
            _signed(EDGE_WORTH_PERCENT.get(name)),
        )
        for name in interactions
    )
    means = (f"{worth['mean']:+.1f}" for worth in worths.values())
    return Grid(
        f"percent by which {terms} reduce the vertex error, over all methods",
        ("interaction", *against, paper),
        rows,
        (("mean", *means, _signed(MEAN_EDGE_WORTH_PERCENT)),),
    )


def shown_grids(result: Mapping[str, Any]) -> Sequence[Grid]:
    """Return the tables that a terminal shows of a result."""
    shown = [error_grid(result["methods"]), measures_grid(result["methods"])]
    if result["worth"]:
        shown.append(worth_grid(result["terms"], result["worth"]))
    return shown


def _published_ratio(value: float | None) -> float | None:
    return None if value is None else value / VERTEX_ERROR_CM[REFERENCE_METHOD]


def _spread(figures: Mapping[str, float]) -> str:
    return f"{figures['vertex_error_cm']:.1f} ± {figures['sd']:.1f}"


def _digits(measure: str) -> int:
    """Return the number of digits behind the point: of a correlation one says little."""
    return 2 if measure == "stated_rank_correlation" else 1


def _number(value: float | None, digits: int = 1) -> str:
    return NOTHING if value is None else f"{value:.{digits}f}"


def _signed(value: float | None) -> str:
    return NOTHING if value is None else f"{value:+.1f}"
