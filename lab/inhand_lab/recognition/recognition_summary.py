"""Sums up trials of recognition: means by method and action, and which method is better where."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from inhand_lab.recognition.recognition_protocol import CASCADES, RecognitionTrial

PAPER_PERSON_PIXELS = 400.0
"""Height of people in the images of Darby et al. 2012; errors are given as they would be there."""


def summarise_recognition(trials: Sequence[RecognitionTrial]) -> dict[str, Any]:
    """Return means by method and action; pixels are scaled to a person of 400 pixels."""
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
    height = float(np.mean([trial.person_pixels for trial in trials]))
    return {"methods": methods, "person_pixels": height, "better_in": _better_in(methods)}


def _means(trials: Sequence[RecognitionTrial]) -> dict[str, float | None]:
    scores = [trial.score for trial in trials]
    return {
        "box_error_pixels": _mean(
            [t.score.box_error_pixels * PAPER_PERSON_PIXELS / t.person_pixels for t in trials]
        ),
        "known_percent": _mean([_times_100(s.recognised_share) for s in scores]),
        "precision_percent": _mean([_times_100(s.precision) for s in scores]),
        "right_percent": _mean([_times_100(s.right_share) for s in scores]),
        "vertex_error_cm": _mean([_times_100(s.vertex_error_m) for s in scores]),
    }


def _better_in(methods: dict[str, Any]) -> dict[str, dict[str, int]]:
    """Number of interactions in which each cascade is better than each adaptive tracker."""
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
    """Mean of the values that there are; None where there is none."""
    finite = [value for value in values if value is not None and np.isfinite(value)]
    return float(np.mean(finite)) if finite else None


def _times_100(value: float | None) -> float | None:
    return None if value is None else 100.0 * value
