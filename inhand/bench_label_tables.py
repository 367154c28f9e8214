"""Tables of how far labels between keyframes are from the truth."""

from collections.abc import Sequence
from statistics import mean

from inhand_lab.benchmarks.label_errors import COUNTED_KINDS, KINDS, LabelCheck, LabelErrors
from rich.console import Group
from rich.table import Table

from inhand.results import listing


def labels_table(checks: Sequence[LabelCheck]) -> Group:
    """A row an interaction: medians where the object is visible, and where it is not."""
    return Group(
        _table("a third or more of the object is visible", [(c, c.visible) for c in checks]),
        _table("less of it is visible", [(c, c.hidden) for c in checks if c.hidden[0].frames]),
        _needed_table(checks),
    )


def _needed_table(checks: Sequence[LabelCheck]) -> Table:
    """A row an interaction: how many keyframes each kind of labels needs."""
    title = (
        "fewest keyframes a recording that reach the aims in place, and in place and turn "
        "(frames from one to the next)"
    )
    table = listing(("interaction",), COUNTED_KINDS, title)
    for check in checks:
        cells = (
            f"{_count(one.keyframes_for_place, one.every_for_place)}, "
            f"{_count(one.keyframes, one.every)}"
            for one in check.needed
        )
        table.add_row(check.interaction, *cells)
    return table


def _count(keyframes: int | None, every: int | None) -> str:
    return "more" if every is None else f"{keyframes} ({every})"


def _table(title: str, rows: Sequence[tuple[LabelCheck, Sequence[LabelErrors]]]) -> Table:
    table = listing(
        ("interaction",),
        ("frames", *KINDS, "doubt"),
        f"{title}: median errors, mm and degrees (doubt: its rank correlation with the error)",
    )
    for check, errors in rows:
        told = (one.doubt_correlation for one in errors)
        doubts = [correlation for correlation in told if correlation is not None]
        table.add_row(
            check.interaction,
            str(errors[0].frames),
            *(_cell(one) for one in errors),
            f"{mean(doubts):.2f}" if doubts else "",
        )
    return table


def _cell(errors: LabelErrors) -> str:
    if errors.translation_mm is None:
        return ""
    return f"{errors.translation_mm:.1f}, {errors.rotation_deg:.1f}"
