"""The tables of recognition, beside the published one."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from inhand_lab.recognition.false_objects import FalseObjects
from inhand_lab.recognition.protocol import CASCADES, RecognitionTrial
from inhand_lab.report.grid import NOTHING, Grid

PUBLISHED = {
    "pourCream": (47, 83, 136),
    "answerPhone": (19, 92, 215),
    "drinkFromMug": (16, 89, 198),
    "recordVideo": (27, 86, 307),
    "liftWeights": (18, 93, 212),
    "playFlute": (12, 90, 247),
    "hitTennisBall": (60, 58, 157),
    "hammerNail": (46, 63, 220),
    "paintWall": (38, 63, 151),
    "putOnGlasses": (11, 88, 286),
    "shakeVinegar": (19, 78, 259),
    "magnifyText": (19, 50, 255),
    "putOnShoe": (134, 46, 92),
    "sweepFloor": (33, 96, 175),
    "hitGolfBall": (49, 98, 162),
}
"""Darby et al. 2012, table 1: pixels, precision in percent, pixels of the best adaptive tracker."""
PAPER_PERSON_PIXELS = 400.0
"""How tall people are in the paper's images; errors are given as they would be there."""


def summarise_recognition(trials: Sequence[RecognitionTrial]) -> dict[str, Any]:
    """Means by method and action; pixels are scaled to a person of 400 pixels."""
    interactions = list(dict.fromkeys(trial.interaction for trial in trials))
    methods: dict[str, Any] = {}
    for name in dict.fromkeys(trial.method for trial in trials):
        rows = {
            interaction: _means(
                [t for t in trials if t.method == name and t.interaction == interaction]
            )
            for interaction in interactions
        }
        methods[name] = {
            key: _mean([row[key] for row in rows.values()]) for key in rows[interactions[0]]
        }
        methods[name]["interactions"] = rows
    tall = float(np.mean([trial.person_pixels for trial in trials]))
    return {"methods": methods, "person_pixels": tall, "better_in": _better_in(methods)}


def recognition_grids(result: dict[str, Any]) -> list[Grid]:
    """Errors in pixels with precisions, and what else is measured of the cascades."""
    methods = result["methods"]
    interactions = next(iter(methods.values()))["interactions"]
    rows = []
    for name in interactions:
        cells = [_cell(method["interactions"][name]) for method in methods.values()]
        pixels, precision, adaptive = PUBLISHED.get(name, (NOTHING,) * 3)
        rows.append((name, *cells, f"{pixels} ({precision})", str(adaptive)))
    means = ("mean", *(_cell(method) for method in methods.values()), "37 (78)", "205")
    errors = Grid(
        "box centres: error in pixels at a person of 400 (precision, %)",
        ("interaction", *methods, "P12", "P12's adaptive"),
        tuple(rows),
        (means,),
    )
    measures = [(k, t) for k, t in MEASURES.items() if any(n in methods for n in CASCADES)]
    ours = {name: methods[name] for name in methods if name in CASCADES}
    rest = Grid(
        "means over interactions",
        ("measure", *ours),
        tuple((title, *(_number(m[key]) for m in ours.values())) for key, title in measures),
    )
    return [errors, rest]


MEASURES = {
    "box_error_pixels": "box error, pixels",
    "known_percent": "known, % of frames",
    "precision_percent": "precision of these, %",
    "vertex_error_cm": "vertex error where right, cm",
}


def false_object_grid(found: FalseObjects) -> Grid:
    """Who uses nothing, or does what was not taught."""
    rows = [
        (f"{kind}: {name}", "with images" if images else "skeletons alone", f"{100.0 * share:.1f}")
        for kind, shares, images in (
            ("nothing in use", found.idle, found.images),
            ("other dataset", found.others, found.others_images),
            ("left out of training", found.never_trained, found.images),
        )
        for name, share in shares.items()
    ]
    return Grid("a false object, % of frames", ("people", "seen", "%"), tuple(rows))


def _means(trials: Sequence[RecognitionTrial]) -> dict[str, float | None]:
    scores = [trial.score for trial in trials]
    return {
        "box_error_pixels": _mean(
            [t.score.box_error_pixels * PAPER_PERSON_PIXELS / t.person_pixels for t in trials]
        ),
        "known_percent": _mean([_times(s.known_share, 100.0) for s in scores]),
        "precision_percent": _mean([_times(s.precision, 100.0) for s in scores]),
        "vertex_error_cm": _mean([_times(s.vertex_error_m, 100.0) for s in scores]),
    }


def _better_in(methods: dict[str, Any]) -> dict[str, dict[str, int]]:
    """In how many interactions each cascade is better than each adaptive tracker."""
    counts: dict[str, dict[str, int]] = {}
    for name in (n for n in methods if n in CASCADES):
        for other in (n for n in methods if n not in CASCADES):
            pairs = [
                (row["box_error_pixels"], methods[other]["interactions"][i]["box_error_pixels"])
                for i, row in methods[name]["interactions"].items()
            ]
            counts.setdefault(name, {})[other] = sum(a < b for a, b in pairs)
    return counts


def _mean(values: Sequence[float | None]) -> float | None:
    known = [value for value in values if value is not None and np.isfinite(value)]
    return float(np.mean(known)) if known else None


def _times(value: float | None, factor: float) -> float | None:
    return None if value is None else factor * value


def _cell(row: dict[str, Any]) -> str:
    precision = row["precision_percent"]
    return _number(row["box_error_pixels"]) + ("" if precision is None else f" ({precision:.0f})")


def _number(value: float | None) -> str:
    return NOTHING if value is None else f"{value:.1f}"
