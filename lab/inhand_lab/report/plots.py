"""Plots the paper's figures of a learned mapping (Darby et al. 2014, figures 4 to 6)."""

from pathlib import Path

import numpy as np
from inhand_tracker.geometry.arrays import Array
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from inhand_lab.report.parameters import DEFAULT_REPORT
from inhand_lab.report.part_measures import PartMeasures, least_by_limb

LIMB_COLOURS = ("#000000", "#56b4e9", "#d55e00", "#009e73", "#e69f00")
TRANSLATION_COLOUR, ROTATION_COLOUR = "#0072b2", "#d55e00"
"""Colours of Okabe and Ito, which colour-blind people can distinguish."""
PERCENT = 100.0


def plot_spread(measures: PartMeasures, frame_rate: float, title: str, path: Path) -> None:
    """Plot figure 4: how much the object's pose varies among frames of like body pose."""
    figure = Figure(figsize=(8.0, 3.4), layout="constrained")
    axes = figure.subplots()
    seconds = np.arange(len(measures.translation_spread)) / frame_rate
    _label(axes, "translation, % of body height", TRANSLATION_COLOUR)
    axes.plot(seconds, PERCENT * measures.translation_spread, color=TRANSLATION_COLOUR)
    axes.set(
        title=f"{title}: spread among like body poses",
        xlabel="time, s",
        xlim=(0.0, seconds[-1]),
        ylim=(0.0, None),
    )
    right = axes.twinx()
    _label(right, "rotation, °", ROTATION_COLOUR)
    right.plot(seconds, np.degrees(measures.rotation_spread), "--", color=ROTATION_COLOUR)
    right.set_ylim(0.0, None)
    figure.savefig(path, dpi=DEFAULT_REPORT.dots_per_inch)


def plot_rotation_stability(
    measures: PartMeasures, frame_rate: float, title: str, path: Path
) -> None:
    """Plot figure 5: how much the object turns until the next frame, relative to each limb."""
    figure = Figure(figsize=(8.0, 3.8), layout="constrained")
    axes = figure.subplots()
    _plot_limbs(axes, np.degrees(measures.rotation_steps), frame_rate)
    axes.set(title=f"{title}: relative to each limb", xlabel="time, s", ylabel="turn, ° a frame")
    _add_limbs(figure, axes)
    figure.savefig(path, dpi=DEFAULT_REPORT.dots_per_inch)


def plot_translation(measures: PartMeasures, frame_rate: float, title: str, path: Path) -> None:
    """Plot figure 6: how much the object moves relative to each limb, over how far it is away."""
    figure = Figure(figsize=(8.0, 5.8), layout="constrained")
    above, below = figure.subplots(2, sharex=True)
    _plot_limbs(above, PERCENT * measures.translation_steps, frame_rate)
    _plot_limbs(below, PERCENT * measures.distances, frame_rate)
    above.set(title=f"{title}: relative to each limb", ylabel="move, % of body height a frame")
    below.set(xlabel="time, s", ylabel="distance, % of body height")
    _add_limbs(figure, above)
    figure.savefig(path, dpi=DEFAULT_REPORT.dots_per_inch)


def _plot_limbs(axes: Axes, by_part: Array, frame_rate: float) -> None:
    seconds = np.arange(len(by_part)) / frame_rate
    for (limb, values), colour in zip(least_by_limb(by_part).items(), LIMB_COLOURS, strict=True):
        axes.plot(seconds, values, color=colour, label=limb, linewidth=1.3)
    axes.set(xlim=(0.0, seconds[-1]), ylim=(0.0, None))
    axes.grid(alpha=0.3)


def _add_limbs(figure: Figure, axes: Axes) -> None:
    lines, names = axes.get_legend_handles_labels()
    figure.legend(lines, names, loc="outside lower center", ncols=len(names), frameon=False)


def _label(axes: Axes, text: str, colour: str) -> None:
    axes.set_ylabel(text, color=colour)
    axes.tick_params(axis="y", labelcolor=colour)
