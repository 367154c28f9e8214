"""A picture of what was done on days, side by side."""

from collections.abc import Sequence
from datetime import date
from pathlib import Path

from inhand_outcomes.outcome import adds_up
from inhand_outcomes.totals import DayTotal
from inhand_runtime.errors import InhandError
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from inhand.outcomes_tables import UNITS, days_of, words

COLUMNS = 3
PANEL_INCHES = (4.2, 2.4)
MOST_PANELS = 24
MOST_LABELS = 8
DOTS_PER_INCH = 120

Series = dict[date, float]


def draw_history(totals: Sequence[DayTotal], first: date, last: date, path: Path) -> None:
    """Draw a panel for each object and kind, a bar a day: the amount that adds up, or the number
    of times. Raises InhandError where nothing counts, or the file cannot be written."""
    panels = _panels(totals)
    if not panels:
        raise InhandError(f"there is nothing to draw from {first} to {last}")
    rows = -(-len(panels) // COLUMNS)
    columns = min(COLUMNS, len(panels))
    figure = Figure(
        figsize=(columns * PANEL_INCHES[0], rows * PANEL_INCHES[1]), layout="constrained"
    )
    axes = figure.subplots(rows, columns, squeeze=False).ravel()
    days = days_of(first, last)
    for panel, (title, unit, series) in zip(axes, panels, strict=False):
        _draw_panel(panel, days, series, title, unit)
    for panel in axes[len(panels) :]:
        panel.remove()
    _save(figure, path)


def _panels(totals: Sequence[DayTotal]) -> list[tuple[str, str, Series]]:
    """Title, unit and values of each object and kind, those first that were done most often."""
    by_kind: dict[tuple[str, str], list[DayTotal]] = {}
    for total in totals:
        if total.counted:
            by_kind.setdefault((total.object, total.kind), []).append(total)
    ordered = sorted(by_kind.items(), key=lambda item: -sum(one.times for one in item[1]))
    return [
        (f"{words(object_name)}: {words(kind)}", *_series(found))
        for (object_name, kind), found in ordered[:MOST_PANELS]
    ]


def _series(totals: Sequence[DayTotal]) -> tuple[str, Series]:
    names = {name for total in totals for name in total.amounts if adds_up(name)}
    name = min(names, key=lambda one: (one.endswith("_s"), one), default=None)
    series: Series = {}
    for total in totals:
        amount = total.amounts.get(name) if name is not None else None
        value = float(total.times) if name is None else 0.0 if amount is None else amount.sum
        series[total.day] = series.get(total.day, 0.0) + value
    if name is None:
        return "times", series
    unit = next((text for end, text in UNITS.items() if name.endswith(f"_{end}")), "")
    return unit or words(name.removesuffix("_count")), series


def _draw_panel(panel: Axes, days: Sequence[date], series: Series, title: str, unit: str) -> None:
    panel.bar(range(len(days)), [series.get(day, 0.0) for day in days], color="tab:blue")
    step = -(-len(days) // MOST_LABELS)
    labels = [f"{day:%a}\n{day:%d.%m.}" for day in days]
    panel.set_xticks(range(0, len(days), step), labels[::step], fontsize=8)
    panel.set_xlim(-0.6, len(days) - 0.4)
    panel.set_title(title, fontsize=10)
    panel.set_ylabel(unit)
    panel.spines[["top", "right"]].set_visible(False)


def _save(figure: Figure, path: Path) -> None:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(path, format="png", dpi=DOTS_PER_INCH)
    except OSError as error:
        raise InhandError(f"cannot write {path}: {error.strerror}; choose another file") from None
