"""Writes the scores of an evaluation's trials as text that spreadsheets read."""

import math
from collections.abc import Sequence

from inhand_lab.evaluation.protocol import Trial
from inhand_lab.evaluation.summary import terms_name


def tab_separated(trials: Sequence[Trial]) -> str:
    """Return a header and a line for each trial, their cells separated by tabs."""
    rows = [_row(trial) for trial in trials]
    lines = [list(rows[0]), *([_cell(value) for value in row.values()] for row in rows)]
    return "".join("\t".join(line) + "\n" for line in lines)


def _row(trial: Trial) -> dict[str, str | int | float]:
    candidate, score = trial.candidate, trial.score
    return {
        "method": candidate.method,
        "terms": terms_name(candidate.terms),
        "seed": candidate.seed,
        "interaction": trial.interaction,
        "participant": trial.participant,
        "recording": trial.recording,
        "frames": score.frames,
        "vertex_error_cm": 100.0 * score.vertex_error_m,
        "translation_cm": 100.0 * score.translation_m,
        "rotation_deg": math.degrees(score.rotation_rad),
        "within_5cm_5deg_percent": 100.0 * score.close_share,
        "within_90_percent_region_percent": math.nan
        if score.region_share is None
        else 100.0 * score.region_share,
        "add_area_percent": 100.0 * score.area_under_curve,
        "lost_percent": 100.0 * score.lost_share,
        "losses": score.recoveries.losses,
        "lost_s": score.recoveries.seconds,
        "body_losses": score.body_recoveries.losses,
        "after_body_s": score.body_recoveries.seconds,
    }


def _cell(value: str | float) -> str:
    return f"{value:.3f}" if isinstance(value, float) else str(value)
