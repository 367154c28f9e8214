"""A confusion matrix as a picture."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from inhand_tracker.geometry.arrays import Array
from matplotlib.figure import Figure

DOTS_PER_INCH = 120
DARK = 0.5


def draw_confusions(matrices: dict[str, Array], names: Sequence[str], path: Path) -> None:
    """Matrices (K, K) of shares, by their titles, side by side: true actions down, said across."""
    size = 1.8 + 0.62 * len(names)
    figure = Figure(figsize=(size * len(matrices), size))
    figure.set_layout_engine("constrained", h_pad=0.12, w_pad=0.12)
    every = figure.subplots(1, len(matrices), squeeze=False)[0]
    for axes, (title, shares) in zip(every, matrices.items(), strict=True):
        axes.imshow(shares, cmap="Blues", vmin=0.0, vmax=1.0)
        axes.set_title(title)
        axes.set_xticks(range(len(names)), names, rotation=60, ha="right")
        axes.set_yticks(range(len(names)), names)
        axes.set(xlabel="said", ylabel="true")
        for (row, column), share in np.ndenumerate(shares):
            if share >= 0.005:
                axes.text(
                    column,
                    row,
                    f"{100.0 * share:.0f}",
                    ha="center",
                    va="center",
                    color="white" if share > DARK else "black",
                )
    figure.savefig(path, dpi=DOTS_PER_INCH)
