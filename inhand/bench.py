"""``inhand bench``: what things cost here, in time and memory, as ratios to a named reference."""

import argparse
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Any

from inhand_lab.benchmark_tracker import TrackerSpeed, measure_tracker
from inhand_lab.benchmark_training import SIZES, TrainingCost, benchmark_training, steps
from inhand_lab.workers import usable_cores
from rich.console import Console
from rich.table import Table

from inhand.progress import progress_bars
from inhand.results import write_json


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument("subject", choices=SUBJECTS, metavar="SUBJECT", help=", ".join(SUBJECTS))
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the result")


def run(arguments: argparse.Namespace) -> int:
    """Measure and show the table; raises InhandError."""
    table, result = SUBJECTS[arguments.subject]()
    Console().print(table)
    if arguments.json is not None:
        write_json(arguments.json, result)
    return 0


def tracker_table(speed: TrackerSpeed) -> Table:
    """Rates, and how many times the naive evaluation's."""
    table = Table("on one core", "", title=f"weighing poses by {speed.points} points")
    table.add_row("by edges, a second", f"{speed.edge_hypotheses_per_second:,.0f}")
    table.add_row("by everything, a second", f"{speed.full_hypotheses_per_second:,.0f}")
    table.add_row("by edges, times NumPy one by one", f"{speed.naive_ratio:.0f}")
    return table


def training_table(costs: list[TrainingCost]) -> Table:
    """A column a size; in brackets, how many times the first one's."""
    table = Table("", title="training on simulated people (times the first column's)")
    for cost in costs:
        table.add_column(f"{cost.learning.frames:,} frames", justify="right")
    for name, value in _TRAINING_ROWS.items():
        first = value(costs[0])
        table.add_row(name, *(f"{_short(value(c))} ({_short(value(c) / first)})" for c in costs))
    table.add_section()
    asked = [cost.asking for cost in costs]
    table.add_row("nearest pose found", *(f"{one.found:.0%}" for one in asked))
    table.add_row(
        "nearest pose, times faster than linear search",
        *(_short(one.linear_ms / one.nearest_ms.p50) for one in asked),
    )
    return table


def _short(value: float) -> str:
    return f"{value:,.0f}" if value >= 100.0 else f"{value:.2g}"


def _tracker() -> tuple[Table, dict[str, Any]]:
    speed = measure_tracker()
    return tracker_table(speed), asdict(speed)


def _training() -> tuple[Table, dict[str, Any]]:
    with progress_bars(steps(SIZES)) as advance:
        costs = list(benchmark_training(SIZES, usable_cores(), advance))
    sizes = [{**asdict(cost.learning), **asdict(cost.asking)} for cost in costs]
    return training_table(costs), {"sizes": sizes}


_TRAINING_ROWS: dict[str, Callable[[TrainingCost], float]] = {
    "training, s": lambda cost: cost.learning.training_s,
    "training, CPU s": lambda cost: cost.learning.training_cpu_s,
    "peak memory, MB": lambda cost: cost.learning.peak_memory_mb,
    "model, MB": lambda cost: cost.learning.model_mb,
    "saving, s": lambda cost: cost.learning.save_s,
    "loading, s": lambda cost: cost.asking.load_s,
    "making the index, s": lambda cost: cost.asking.index_s,
    "nearest pose, ms, p50": lambda cost: cost.asking.nearest_ms.p50,
    "nearest pose, ms, p99": lambda cost: cost.asking.nearest_ms.p99,
    "its cluster, ms, p50": lambda cost: cost.asking.cluster_ms.p50,
    "its cluster, ms, p99": lambda cost: cost.asking.cluster_ms.p99,
    "linear search, ms, p50": lambda cost: cost.asking.linear_ms,
}

SUBJECTS: dict[str, Callable[[], tuple[Table, dict[str, Any]]]] = {
    "tracker": _tracker,
    "training": _training,
}
