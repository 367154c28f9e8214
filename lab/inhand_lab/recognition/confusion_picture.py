"""Draws confusion matrices into a picture."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from inhand_tracker.geometry.arrays import Array
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from inhand_lab.recognition.parameters import (
    DEFAULT_RECOGNITION_EVALUATION,
    RecognitionEvaluationParameters,
)


def draw_confusions(
    matrices: dict[str, Array],
    names: Sequence[str],
    path: Path,
    parameters: RecognitionEvaluationParameters = DEFAULT_RECOGNITION_EVALUATION,
) -> None:
    """Draw matrices (K, K) of shares, by their titles, side by side: true actions down, answers
    across."""
    side = parameters.frame_inches + parameters.cell_inches * len(names)
    figure = Figure(figsize=(side * len(matrices), side))
    gap = parameters.gap_inches
    figure.set_layout_engine("constrained", h_pad=gap, w_pad=gap)
    every = figure.subplots(1, len(matrices), squeeze=False)[0]
    for axes, (title, shares) in zip(every, matrices.items(), strict=True):
        axes.imshow(shares, cmap="Blues", vmin=0.0, vmax=1.0)
        axes.set_title(title)
        axes.set_xticks(range(len(names)), names, rotation=60, ha="right")
        axes.set_yticks(range(len(names)), names)
        axes.set(xlabel="said", ylabel="true")
        _write_shares(axes, shares, parameters)
    figure.savefig(path, dpi=parameters.dots_per_inch)


def _write_shares(axes: Axes, shares: Array, parameters: RecognitionEvaluationParameters) -> None:
    """Write percentages into the cells of a matrix (K, K)."""
    for (row, column), share in np.ndenumerate(shares):
        if share >= parameters.least_shown_share:
            colour = "white" if share > parameters.dark_share else "black"
            percent = f"{100.0 * share:.0f}"
            axes.text(column, row, percent, ha="center", va="center", color=colour)
