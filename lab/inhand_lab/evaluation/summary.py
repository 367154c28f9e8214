"""Summarises trials as the figures of a table.

A participant's error is the mean over its recordings and seeds; a cell is the mean and the standard
deviation over participants (over recordings, where there is one participant); a method's figure is
the mean over interactions, of the worst recording the worst of all.
"""

from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
from scipy.stats import spearmanr

from inhand_lab.evaluation.lost_tracks import Recoveries
from inhand_lab.evaluation.protocol import Terms, Trial
from inhand_lab.evaluation.published import REFERENCE_METHOD, VERTEX_ERROR_CM
from inhand_lab.evaluation.scoring import Score

Figures = dict[str, float | None]
WORST = "worst_recording_cm"
"""The figure that is the largest vertex error of a recording in any fold."""
RANKED = "stated_rank_correlation"
"""The figure that says how well stated deviations rank errors: Spearman's, over all frames."""


def summarise(trials: Sequence[Trial]) -> dict[str, Any]:
    """Give ``{METHOD: {vertex_error_cm, sd, …, interactions: {I: {…}}}}`` for one set of terms."""
    summary: dict[str, Any] = {}
    for method in _distinct(trial.candidate.method for trial in trials):
        of_method = [trial for trial in trials if trial.candidate.method == method]
        cells = {
            interaction: _cell([t for t in of_method if t.interaction == interaction])
            for interaction in _distinct(trial.interaction for trial in of_method)
        }
        means = {key: _over_interactions(key, cells.values()) for key in _FIGURES}
        means[RANKED] = _rank_correlation(of_method)
        summary[method] = {**means, "paper_cm": VERTEX_ERROR_CM.get(method), "interactions": cells}
    reference = summary.get(REFERENCE_METHOD)
    for figures in summary.values():
        figures["ratio"] = reference and figures["vertex_error_cm"] / reference["vertex_error_cm"]
    return summary


def with_terms(trials: Iterable[Trial], terms: Terms) -> list[Trial]:
    """Return the trials of one choice of terms."""
    return [trial for trial in trials if trial.candidate.terms == terms]


def worth(trials: Sequence[Trial], terms: Terms, without: Terms) -> dict[str, Any]:
    """Return the percentage by which terms reduce the vertex error, over participants and methods.

    ``{interactions: {I: percent}, mean: percent}``, as the paper reports it in section 7.
    """
    percents = {}
    for interaction in _distinct(trial.interaction for trial in trials):
        here = [trial for trial in trials if trial.interaction == interaction]
        error, before = (
            np.mean([trial.score.vertex_error_m for trial in with_terms(here, chosen)])
            for chosen in (terms, without)
        )
        percents[interaction] = float(100.0 * (1.0 - error / before))
    return {"interactions": percents, "mean": float(np.mean(list(percents.values())))}


def terms_name(terms: Terms) -> str:
    """Return terms as people write them: ``own``, ``edges``, ``edges+depth``, or ``none``."""
    return terms if terms == "own" else "+".join(terms) or "none"


def _over_interactions(key: str, cells: Iterable[Figures]) -> float | None:
    """Return the mean of a figure, and of the worst recording's error the worst."""
    given = [value for cell in cells if (value := cell[key]) is not None]
    if not given:
        return None
    return max(given) if key == WORST else _mean(given)


def _cell(trials: Sequence[Trial]) -> Figures:
    return {key: figure(trials) for key, figure in _FIGURES.items()}


def _errors_cm(trials: Sequence[Trial]) -> list[float]:
    """Return each participant's vertex error, or each recording's of a single participant."""
    names = [trial.participant for trial in trials]
    if len(set(names)) == 1:
        names = [trial.recording for trial in trials]
    errors: defaultdict[str, list[float]] = defaultdict(list)
    for name, trial in zip(names, trials, strict=True):
        errors[name].append(100.0 * trial.score.vertex_error_m)
    return [_mean(one) for one in errors.values()]


def _mean_of(figure: Callable[[Score], float]) -> Callable[[Sequence[Trial]], float]:
    return lambda trials: _mean([figure(trial.score) for trial in trials])


def _mean_recovery(
    recoveries: Callable[[Score], Recoveries],
) -> Callable[[Sequence[Trial]], float | None]:
    def mean(trials: Sequence[Trial]) -> float | None:
        counted = [recoveries(trial.score) for trial in trials]
        losses = sum(one.losses for one in counted)
        return sum(one.seconds for one in counted) / losses if losses else None

    return mean


_FIGURES: dict[str, Callable[[Sequence[Trial]], float | None]] = {
    "vertex_error_cm": lambda trials: _mean(_errors_cm(trials)),
    "sd": lambda trials: float(np.std(_errors_cm(trials))),
    WORST: lambda trials: max(100.0 * trial.score.vertex_error_m for trial in trials),
    "rotation_deg": _mean_of(lambda score: float(np.degrees(score.rotation_rad))),
    "translation_cm": _mean_of(lambda score: 100.0 * score.translation_m),
    "within_5cm_5deg_percent": _mean_of(lambda score: 100.0 * score.close_share),
    "within_90_percent_region_percent": lambda trials: _mean_share(
        [trial.score.region_share for trial in trials]
    ),
    RANKED: lambda trials: _rank_correlation(trials),
    "add_area_percent": _mean_of(lambda score: 100.0 * score.area_under_curve),
    "lost_percent": _mean_of(lambda score: 100.0 * score.lost_share),
    "recovery_s": _mean_recovery(lambda score: score.recoveries),
    "body_recovery_s": _mean_recovery(lambda score: score.body_recoveries),
}


def _rank_correlation(trials: Sequence[Trial]) -> float | None:
    """Spearman's correlation of what covariances state with the errors, over all frames; None where
    none has a covariance, or all state the same."""
    pairs = np.array([pair for trial in trials for pair in trial.score.stated]).reshape(-1, 2)
    if len(pairs) < 2 or (pairs == pairs[0]).all(axis=0).any():
        return None
    return float(spearmanr(pairs[:, 0], pairs[:, 1]).statistic)


def _mean_share(shares: Sequence[float | None]) -> float | None:
    mean = _mean_of_given(shares)
    return None if mean is None else 100.0 * mean


def _mean_of_given(values: Iterable[float | None]) -> float | None:
    given = [value for value in values if value is not None]
    return _mean(given) if given else None


def _mean(values: Sequence[float]) -> float:
    return float(np.mean(values))


def _distinct(names: Iterable[str]) -> list[str]:
    return list(dict.fromkeys(names))
