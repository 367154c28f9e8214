"""``inhand bench``: measure what things cost here, and check what they are worth."""

import argparse
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from inhand_lab.benchmarks.ablation import Worth, ablate, varied
from inhand_lab.benchmarks.constants import ConstantCheck, check_constants
from inhand_lab.benchmarks.likelihood_check import ObjectCheck, check_likelihood
from inhand_lab.benchmarks.parameters import DEFAULT_TRAINING_COST
from inhand_lab.benchmarks.tracker_speed import TrackerSpeed, measure_tracker
from inhand_lab.benchmarks.training_cost import (
    TrainingCost,
    benchmark_training,
    training_steps,
)
from inhand_lab.datasets.dataset import load_dataset
from inhand_lab.evaluation.folds import leave_one_out
from inhand_lab.workers import usable_cores
from inhand_runtime.errors import SettingsError
from rich.console import Console, Group, RenderableType
from rich.table import Table

from inhand.progress import progress_bar, progress_bars
from inhand.results import write_json


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument(
        "subject",
        choices=SUBJECTS,
        metavar="SUBJECT",
        help="; ".join(f"{subject}: {text}" for subject, text in SUBJECTS_HELP.items()),
    )
    parser.add_argument(
        "source",
        nargs="?",
        type=Path,
        metavar="SOURCE",
        help="for likelihood: a folder of YCB-Video, or of an excerpt; for ablation and "
        "constants: a dataset",
    )
    parser.add_argument(
        "--vary",
        action="append",
        default=[],
        metavar="FIELD=VALUE",
        help="for ablation: a parameter of fusion with another value, in place of the parts taken "
        "out; may be repeated",
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the result")


def run(arguments: argparse.Namespace) -> int:
    """Measure and show the table; raises InhandError."""
    if (arguments.subject in MEASURED_ON) != (arguments.source is not None):
        raise SettingsError(
            f"{', '.join(MEASURED_ON)}, and nothing else, are measured on a SOURCE: name it"
        )
    if arguments.vary and arguments.subject != "ablation":
        raise SettingsError("--vary is for ablation, and for nothing else: leave it out")
    table, result = SUBJECTS[arguments.subject](arguments)
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


def frames_table(speed: TrackerSpeed) -> Table:
    """What a frame costs by hypotheses and objects, with NumPy's edges alone beside it."""
    cores = {cost.cores for cost in speed.frames}
    table = Table(
        title=f"a frame, every term, on {max(cores, default=1)} cores, ms "
        "(NumPy, edges alone, one by one)"
    )
    table.add_column("hypotheses an object", justify="right")
    objects = list(dict.fromkeys(cost.objects for cost in speed.frames))
    for count in objects:
        table.add_column("1 object" if count == 1 else f"{count} objects", justify="right")
    for hypotheses in dict.fromkeys(cost.hypotheses for cost in speed.frames):
        costs = [cost for cost in speed.frames if cost.hypotheses == hypotheses]
        cells = [f"{cost.ms:.1f} ({cost.naive_ms:,.0f})" for cost in costs]
        table.add_row(f"{hypotheses:,}", *cells)
    return table


def fusion_table(speed: TrackerSpeed) -> Table:
    """What a frame of fusion costs by the size of its training."""
    table = Table(title="a frame of fusion, by what its prior was learned from")
    for name in ("labelled frames", "learning, s", "without image, ms", "with image, ms"):
        table.add_column(name, justify="right")
    for cost in speed.fusion:
        table.add_row(
            f"{cost.frames:,}",
            f"{cost.learning_s:.1f}",
            f"{cost.unseen_ms:.1f}",
            f"{cost.seen_ms:.1f}",
        )
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


def likelihood_table(checks: list[ObjectCheck]) -> Table:
    """A row an object."""
    table = Table(
        title="from 3 cm and 10° off, refined (medians), in real frames",
        caption="rank: of the true pose's likelihood, among 10,000 poses scattered by 5 cm and "
        "20°; box and cup (without a handle) are fitted to the surface that is seen",
    )
    for name in ("object", "shape", "frames", "mm", "90 %", "degrees", "90 %", "rank"):
        table.add_column(name, justify="left" if name in ("object", "shape") else "right")
    for check in checks:
        table.add_row(
            check.name,
            check.shape,
            str(check.frames),
            f"{check.translation_mm:.1f}",
            f"{check.translation_90_mm:.1f}",
            f"{check.rotation_deg:.1f}",
            f"{check.rotation_90_deg:.1f}",
            f"{check.rank:.2%} (≤ {check.worst_rank:.2%})",
        )
    return table


def _short(value: float) -> str:
    return f"{value:,.0f}" if value >= 100.0 else f"{value:.2g}"


def _tracker(_: argparse.Namespace) -> tuple[RenderableType, dict[str, Any]]:
    speed = measure_tracker()
    return Group(tracker_table(speed), frames_table(speed), fusion_table(speed)), asdict(speed)


def _likelihood(arguments: argparse.Namespace) -> tuple[RenderableType, dict[str, Any]]:
    checks = check_likelihood(arguments.source)
    return likelihood_table(checks), {"objects": [asdict(check) for check in checks]}


def ablation_table(worths: Sequence[Worth]) -> Table:
    """Each variant's error, and how many times the whole method's."""
    table = Table("of", "without", "vertex error, cm", "ratio", title="fusion, a part taken out")
    whole = worths[0].vertex_error_cm
    for worth in worths:
        error, variant = worth.vertex_error_cm, worth.variant
        _, separator, value = variant.instead.partition("=")
        instead = f" (instead {value.strip()})" if separator else ""
        table.add_row(
            variant.part, variant.without + instead, f"{error:.2f}", f"{error / whole:.2f}"
        )
    return table


def _ablation(arguments: argparse.Namespace) -> tuple[RenderableType, dict[str, Any]]:
    varied(arguments.vary)  # a wrong setting is refused before anything is loaded
    dataset = load_dataset(arguments.source)
    with progress_bar("evaluating", len(leave_one_out(dataset))) as advance:
        worths = ablate(dataset, usable_cores(), advance, arguments.vary)
    return ablation_table(worths), {"variants": [_ablation_row(worth) for worth in worths]}


def constants_table(checks: Sequence[ConstantCheck]) -> Table:
    """A row a number, and how many times the usual error that errs which is halved or doubled."""
    table = Table(
        "number",
        "usual",
        "lower",
        "ratio",
        "higher",
        "ratio",
        title="fusion's numbers, each changed by itself: vertex error, times the usual one",
    )
    for check in checks:
        table.add_row(
            check.name,
            f"{check.usual:g}",
            f"{check.lower:g}",
            f"{check.lower_ratio:.3f}",
            f"{check.higher:g}",
            f"{check.higher_ratio:.3f}",
        )
    return table


def _constants(arguments: argparse.Namespace) -> tuple[RenderableType, dict[str, Any]]:
    dataset = load_dataset(arguments.source)
    with progress_bar("evaluating", len(leave_one_out(dataset))) as advance:
        checks = check_constants(dataset, usable_cores(), advance)
    return constants_table(checks), {"numbers": [asdict(check) for check in checks]}


def _ablation_row(worth: Worth) -> dict[str, Any]:
    variant = worth.variant
    instead = {"instead": variant.instead} if variant.instead else {}
    return {
        "part": variant.part,
        "without": variant.without,
        **instead,
        "vertex_error_cm": worth.vertex_error_cm,
    }


def _training(_: argparse.Namespace) -> tuple[RenderableType, dict[str, Any]]:
    with progress_bars(training_steps(DEFAULT_TRAINING_COST.sizes)) as advance:
        costs = list(benchmark_training(DEFAULT_TRAINING_COST.sizes, usable_cores(), advance))
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

SUBJECTS_HELP = {
    "ablation": "the error of fusion without each of its parts",
    "constants": "its error with each number halved and doubled",
    "likelihood": "how true poses score, and refine, on real frames of YCB-Video",
    "tracker": "poses weighed in a second, and what a frame costs",
    "training": "time and memory of training by its size",
}

MEASURED_ON = ("likelihood", "ablation", "constants")

SUBJECTS: dict[str, Callable[[Any], tuple[RenderableType, dict[str, Any]]]] = {
    "ablation": _ablation,
    "constants": _constants,
    "likelihood": _likelihood,
    "tracker": _tracker,
    "training": _training,
}
