"""``inhand evaluate``: how well unseen people's objects are tracked."""

import argparse
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from inhand_lab.datasets.dataset import load_dataset
from inhand_lab.evaluation.folds import Added, leave_out, train_on_one_test_on_other
from inhand_lab.evaluation.protocol import Protocol, Terms, Trial, evaluate
from inhand_lab.evaluation.summary import summarise, terms_name, with_terms, worth
from inhand_lab.report.report_folder import prepare_report_folder, write_report
from inhand_lab.report.tables import shown_grids
from inhand_lab.workers import usable_cores, working
from inhand_runtime.errors import SettingsError
from inhand_tracker.methods.darby2014.variants import TABLE_1
from inhand_tracker.methods.registry import ALL_TERMS, FUSION, METHODS, MethodName
from rich.console import Console

from inhand.cluster import add_cluster_option, work_path
from inhand.looking import positive_count
from inhand.progress import add_progress_option, progress_bar
from inhand.results import write_json


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument("dataset", type=Path, metavar="DATASET", help="learn from it")
    tested = parser.add_mutually_exclusive_group()
    tested.add_argument("--test-on", type=Path, metavar="DATASET", help="test on another one")
    tested.add_argument(
        "--leave-out",
        type=positive_count,
        default=1,
        metavar="N",
        help="test on any N people (recordings, of one person), taught by the others, every choice "
        "(default: 1)",
    )
    parser.add_argument(
        "--with",
        dest="added",
        type=_added,
        action="append",
        default=[],
        metavar="PARTICIPANT[:N]",
        help="with --test-on: learn from a participant of the tested dataset as well, by N of the "
        "recordings of each interaction or all, and test the others; may be given again",
    )
    parser.add_argument(
        "--methods",
        default=",".join((*TABLE_1, FUSION)),
        metavar="a,b",
        help="(default: all of the published Table 1, and fusion)",
    )
    images = parser.add_mutually_exclusive_group()
    images.add_argument("--no-images", action="store_true", help="from bodies alone: --terms none")
    images.add_argument(
        "--terms",
        default="own",
        metavar="a,b",
        help="what of an image weighs: own (what usually does in each method, the default), none, "
        f"or any of {'+'.join(ALL_TERMS)}; the first is reported, and how much better it is than "
        "the others",
    )
    parser.add_argument("--seeds", type=int, default=1, metavar="N", help="repetitions (1)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the result")
    parser.add_argument("--report", type=Path, metavar="DIR", help="write tables and figures")
    add_cluster_option(parser)
    add_progress_option(parser)


def run(arguments: argparse.Namespace) -> int:
    """Evaluate and show the tables; raises SettingsError, DatasetError or RecordingError."""
    began = time.monotonic()
    protocol = _protocol(arguments)
    if arguments.report is not None:
        prepare_report_folder(arguments.report)
    lines = arguments.progress_lines
    with (
        working(arguments.cluster) as cores,
        progress_bar("evaluating", protocol.trials(), lines=lines) as advance,
    ):
        trials = evaluate(protocol, cores, advance)
    result = _result(protocol, trials, time.monotonic() - began)
    console = Console()
    for grid in shown_grids(result):
        console.print(grid.for_terminal(), "")
    for note in result["notes"]:
        console.print(note)
    if arguments.json is not None:
        write_json(arguments.json, result)
    if arguments.report is not None:
        with progress_bar("drawing", len(protocol.trained.interactions())) as advance:
            write_report(arguments.report, protocol, trials, result, usable_cores(), advance)
        console.print(f"the report is {arguments.report / 'report.md'}")
    return 0


def _protocol(arguments: argparse.Namespace) -> Protocol:
    methods = arguments.methods.split(",")
    unknown = [name for name in methods if name not in METHODS]
    if unknown:
        raise SettingsError(f"no method {unknown[0]!r}; there are: {', '.join(METHODS)}")
    if arguments.added and arguments.test_on is None:
        raise SettingsError("--with adds people of what --test-on tests: name that as well")
    if arguments.seeds < 1:
        raise SettingsError("--seeds is 1 or more")
    methods = tuple(name for name in METHODS if name in methods)
    terms = "none" if arguments.no_images else arguments.terms
    chosen = tuple(dict.fromkeys(_terms(name, methods) for name in terms.split(",")))
    trained = load_dataset(work_path(arguments, arguments.dataset))
    tested = (
        trained
        if arguments.test_on is None
        else load_dataset(work_path(arguments, arguments.test_on))
    )
    folds = (
        leave_out(trained, arguments.leave_out)
        if arguments.test_on is None
        else train_on_one_test_on_other(trained, tested, arguments.added)
    )
    return Protocol(
        trained,
        tested,
        tuple(folds),
        methods,
        chosen,
        arguments.seeds,
    )


def _added(text: str) -> Added:
    """Read PARTICIPANT or PARTICIPANT:N, as argparse does."""
    name, separator, count = text.rpartition(":")
    return Added(name, positive_count(count)) if separator else Added(text)


def _terms(name: str, methods: Sequence[MethodName]) -> Terms:
    if name == "own":
        return "own"
    if name == "none":
        return ()
    named = name.split("+")
    if unknown := [term for term in named if term not in ALL_TERMS]:
        raise SettingsError(f"no term {unknown[0]!r}; there are: own, none, {', '.join(ALL_TERMS)}")
    for method in methods:
        if unknown := [term for term in named if term not in METHODS[method].terms]:
            raise SettingsError(
                f"{method} does not weigh {unknown[0]!r}; "
                f"it knows: {', '.join(METHODS[method].terms)}"
            )
    return tuple(term for term in ALL_TERMS if term in named)


def _result(protocol: Protocol, trials: list[Trial], seconds: float) -> dict[str, Any]:
    reported, *others = protocol.terms
    return {
        "methods": summarise(with_terms(trials, reported)),
        "terms": terms_name(reported),
        "compared": {terms_name(one): summarise(with_terms(trials, one)) for one in others},
        "worth": {terms_name(one): worth(trials, reported, one) for one in others},
        "notes": protocol.notes(),
        "frames": sum(trial.score.frames for trial in trials),
        "seconds": seconds,
    }
