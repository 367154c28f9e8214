"""Tables of ``inhand bench outcomes``."""

from collections import Counter, defaultdict

import numpy as np
from rich.table import Table

from inhand.bench_outcomes import Compared, Handled, OutcomesCheck


def all_tables(check: OutcomesCheck) -> list[Table]:
    """Counts, amounts, places, maps, and what was mistaken."""
    makers = (counts_table, amounts_table, places_table, swept_table, mistaken_table)
    return [make(check) for make in makers]


def counts_table(check: OutcomesCheck) -> Table:
    """How often each kind was counted right."""
    table = Table(title=f"achieved in {check.recordings} recordings with {check.skeletons}")
    for column in ("interaction", "kind"):
        table.add_column(column)
    for column in ("true", "said", "exact", "within one", "seconds off"):
        table.add_column(column, justify="right")
    rows: dict[tuple[str, str], list[Compared]] = defaultdict(list)
    for one in check.compared:
        rows[one.interaction, one.kind].append(one)
    for (interaction, kind), ones in rows.items():
        off = Counter(abs(one.said - one.true) for one in ones)
        table.add_row(
            interaction,
            kind,
            str(sum(one.true for one in ones)),
            str(sum(one.said for one in ones)),
            f"{off[0]}/{len(ones)}",
            f"{off[0] + off[1]}/{len(ones)}",
            f"{np.median(np.abs([one.seconds_off for one in ones])):.2f}",
        )
    return table


def amounts_table(check: OutcomesCheck) -> Table:
    """How far sums of amounts are from the truth."""
    table = Table(title=f"amounts of a recording together, with {check.skeletons}")
    for column in ("interaction", "kind", "amount"):
        table.add_column(column)
    for column in ("true, mean", "median error", "within 25 %"):
        table.add_column(column, justify="right")
    rows: dict[tuple[str, str, str], list[tuple[float, float]]] = defaultdict(list)
    for one in check.compared:
        for name, pair in one.amounts.items():
            rows[one.interaction, one.kind, name].append(pair)
    for key, pairs in rows.items():
        said, true = np.array(pairs).T
        near = np.abs(said - true) <= 0.25 * np.abs(true)
        table.add_row(
            *key,
            f"{true.mean():.3g}",
            f"{np.median(np.abs(said - true)):.3g}",
            f"{near.sum()}/{len(pairs)}",
        )
    return table


def swept_table(check: OutcomesCheck) -> Table:
    """How well maps of the swept floor agree with what truly was."""
    table = Table(title=f"the swept floor, intersection over union, with {check.skeletons}")
    for column in ("recordings", "mean", "least"):
        table.add_column(column, justify="right")
    shares = [one.iou for one in check.swept]
    if shares:
        table.add_row(str(len(shares)), f"{np.mean(shares):.2f}", f"{min(shares):.2f}")
    return table


def places_table(check: OutcomesCheck) -> Table:
    """How far from where it lies a thing was said to be put down."""
    table = Table(title=f"where things were put down, with {check.skeletons}")
    table.add_column("interaction")
    for column in ("put down", "said", "within 5 cm", "median, cm"):
        table.add_column(column, justify="right")
    rows: dict[str, list[Handled]] = defaultdict(list)
    for one in check.handled:
        rows[one.interaction].append(one)
    for interaction, ones in rows.items():
        off = [one.place_off_cm for one in ones if one.place_off_cm is not None]
        table.add_row(
            interaction,
            str(len(ones)),
            str(len(off)),
            str(sum(one <= 5.0 for one in off)),
            f"{np.median(off):.1f}" if off else "",
        )
    return table


def mistaken_table(check: OutcomesCheck) -> Table:
    """What was said of objects that were not there."""
    table = Table(title=f"said of other objects in {check.recordings} recordings")
    for column in ("interaction", "object", "kind"):
        table.add_column(column)
    table.add_column("said", justify="right")
    rows: Counter[tuple[str, str, str]] = Counter()
    for one in check.mistaken:
        rows[one.interaction, one.object, one.kind] += one.said
    for key, said in rows.items():
        table.add_row(*key, str(said))
    return table
