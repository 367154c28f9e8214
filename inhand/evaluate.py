"""``inhand evaluate``: how well unseen people's objects are tracked."""

import argparse
import os
import time
from pathlib import Path
from typing import Any

from inhand_lab.dataset import load_dataset
from inhand_lab.evaluation import (
    SequenceScore,
    evaluate,
    leave_one_out,
    summarise,
    train_on_one_test_on_other,
)
from inhand_runtime.errors import SettingsError
from inhand_tracker.methods import METHODS
from rich.console import Console
from rich.table import Table

from inhand.progress import progress_bar
from inhand.results import write_json


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument("dataset", type=Path, metavar="DATASET", help="learn from it")
    parser.add_argument("--test-on", type=Path, metavar="DATASET", help="test on another one")
    parser.add_argument(
        "--methods", default=",".join(METHODS), metavar="a,b", help="(default: all of Table 1)"
    )
    parser.add_argument("--no-images", action="store_true", help="from bodies alone")
    parser.add_argument("--seeds", type=int, default=1, metavar="N", help="repetitions (1)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the result")
    parser.add_argument("--report", type=Path, metavar="DIR", help="write table and sequences")


def run(arguments: argparse.Namespace) -> int:
    """Evaluate and show the table; raises SettingsError or DatasetError."""
    methods = arguments.methods.split(",")
    unknown = [name for name in methods if name not in METHODS]
    if unknown:
        raise SettingsError(f"no method {unknown[0]!r}; there are: {', '.join(METHODS)}")
    if arguments.seeds < 1:
        raise SettingsError("--seeds is 1 or more")
    began = time.monotonic()
    trained = load_dataset(arguments.dataset)
    tested = trained if arguments.test_on is None else load_dataset(arguments.test_on)
    folds = (
        leave_one_out(trained)
        if arguments.test_on is None
        else train_on_one_test_on_other(trained, tested)
    )
    with progress_bar("evaluating", len(folds)) as advance:
        scores = evaluate(
            trained,
            tested,
            folds,
            methods,
            arguments.seeds,
            images=not arguments.no_images,
            processes=len(os.sched_getaffinity(0)),
            on_progress=advance,
        )
    result: dict[str, Any] = {
        "methods": summarise(scores),
        "frames": sum(score.frames for score in scores),
        "seconds": time.monotonic() - began,
    }
    Console().print(_table(result["methods"]))
    if arguments.json is not None:
        write_json(arguments.json, result)
    if arguments.report is not None:
        _write_report(arguments.report, result, scores)
    return 0


def _table(methods: dict[str, Any]) -> Table:
    table = Table("interaction", title="vertex error in cm: mean ± sd over participants")
    for name in methods:
        table.add_column(name, justify="right")
    interactions = next(iter(methods.values()))["interactions"]
    for interaction in interactions:
        cells = [method["interactions"][interaction] for method in methods.values()]
        table.add_row(interaction, *(_cell(cell) for cell in cells))
    table.add_section()
    table.add_row("mean", *(_cell(method) for method in methods.values()))
    return table


def _cell(values: dict[str, float]) -> str:
    return f"{values['vertex_error_cm']:.1f} ± {values['sd']:.1f}"


def _write_report(folder: Path, result: dict[str, Any], scores: list[SequenceScore]) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    write_json(folder / "evaluation.json", result)
    with (folder / "table.txt").open("w", encoding="utf-8") as file:
        Console(file=file, width=120).print(_table(result["methods"]))
    lines = ["method\tinteraction\tparticipant\tseed\tframes\tvertex_error_cm"]
    lines += [
        f"{s.method}\t{s.interaction}\t{s.participant}\t{s.seed}\t{s.frames}"
        f"\t{100 * s.vertex_error_m:.3f}"
        for s in scores
    ]
    (folder / "sequences.tsv").write_text("\n".join(lines) + "\n", encoding="utf-8")
