"""``inhand recognise``: measures how well objects that are not given are recognised and tracked."""

import argparse
import math
import time
from dataclasses import asdict
from pathlib import Path
from typing import Any

from inhand_lab.datasets.dataset import Dataset, load_dataset
from inhand_lab.datasets.other_light import RECORDED, Light
from inhand_lab.datasets.recorded_frames import has_images
from inhand_lab.recognition.adaptive_comparison import Environments
from inhand_lab.recognition.cascade_learning import labelled_entries
from inhand_lab.recognition.false_objects import FalseObjectProtocol
from inhand_lab.recognition.false_objects_by_movement import count_by_movement
from inhand_lab.recognition.false_objects_with_images import count_with_images
from inhand_lab.recognition.movement_alone import RecognitionAlone, recognise_alone
from inhand_lab.recognition.movement_on_others import recognise_others, transfer_steps
from inhand_lab.recognition.parameters import DEFAULT_RECOGNITION_EVALUATION
from inhand_lab.recognition.recognition_protocol import (
    CASCADES,
    TRACKING,
    RecognitionProtocol,
    evaluate_recognition,
)
from inhand_lab.recognition.recognition_summary import summarise_recognition
from inhand_lab.recognition.recognition_tables import (
    false_object_grid,
    known_frames_grid,
    light_grid,
    recognition_grids,
)
from inhand_lab.report.grid import Grid
from inhand_lab.report.report_folder import prepare_report_folder
from inhand_lab.workers import usable_cores
from inhand_runtime.errors import SettingsError
from inhand_tracker.methods.registry import METHODS
from rich.console import Console

from inhand.progress import progress_bar
from inhand.results import write_json


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument("dataset", type=Path, metavar="DATASET")
    what = parser.add_mutually_exclusive_group()
    what.add_argument(
        "--alone",
        action="store_true",
        help="recognition alone, without objects or images: every participant left out once",
    )
    what.add_argument(
        "--false-objects",
        action="store_true",
        help="people who use nothing, and actions that were left out of training: with images "
        "where the dataset has some, else by skeletons alone",
    )
    what.add_argument(
        "--test-on",
        type=Path,
        metavar="DATASET",
        help="recognition alone on the people of another dataset, as of another sensor, and false "
        "objects of idle people and of actions that were left out of training",
    )
    parser.add_argument(
        "--taught-by",
        default="",
        metavar="P,P",
        help="with --test-on: people of that dataset who teach too, and are not tested",
    )
    parser.add_argument(
        "--others",
        type=Path,
        metavar="DATASET",
        help="with --false-objects or --test-on: people whose actions were never trained",
    )
    parser.add_argument(
        "--methods", default=",".join(CASCADES), metavar="a,b", help="(default: both cascades)"
    )
    parser.add_argument(
        "--tracking",
        default=TRACKING,
        metavar="M",
        choices=METHODS,
        help=f"under cascade (default: {TRACKING})",
    )
    parser.add_argument(
        "--unseen", metavar="P,P", help="left out one after the other (default: the first two)"
    )
    parser.add_argument(
        "--adaptive",
        action="store_true",
        help="compare with OpenCV's adaptive trackers, started at the true first box",
    )
    parser.add_argument(
        "--contrib",
        type=Path,
        metavar="PYTHON",
        help="a Python with OpenCV's contrib build, for CSRT and TLD: `make contrib`",
    )
    parser.add_argument(
        "--light",
        action="append",
        default=[],
        metavar="R,G,B",
        help="show what is tested in another light too: factors on red, green and blue, as "
        "0.85,1,1.15; may be repeated",
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the result")
    parser.add_argument("--report", type=Path, metavar="DIR", help="write tables and pictures")


def run(arguments: argparse.Namespace) -> int:
    """Measure and show; raises SettingsError, DatasetError, InhandError or RecordingError."""
    began = time.monotonic()
    if arguments.report is not None:
        prepare_report_folder(arguments.report)
    dataset = load_dataset(arguments.dataset)
    if arguments.alone:
        result, grids = _alone(dataset, arguments.report)
    elif arguments.test_on is not None:
        result, grids = _on_others(dataset, arguments)
    elif arguments.false_objects:
        result, grids = _false_objects(dataset, arguments)
    else:
        result, grids = _cascades(dataset, arguments)
    result["seconds"] = time.monotonic() - began
    console = Console()
    for grid in grids:
        console.print(grid.for_terminal(), "")
    if arguments.json is not None:
        write_json(arguments.json, result)
    if arguments.report is not None:
        text = "\n".join(grid.for_markdown() for grid in grids)
        (arguments.report / "recognition.md").write_text(text, encoding="utf-8")
        console.print(f"the report is {arguments.report / 'recognition.md'}")
    return 0


def _cascades(dataset: Dataset, arguments: argparse.Namespace) -> tuple[dict[str, Any], list[Grid]]:
    methods = tuple(dict.fromkeys(arguments.methods.split(",")))
    if unknown := [name for name in methods if name not in CASCADES]:
        raise SettingsError(f"no method {unknown[0]!r}; there are: {', '.join(CASCADES)}")
    pythons = Environments(arguments.contrib).of() if arguments.adaptive else {}
    lights = {name: _light(name) for name in arguments.light}
    protocol = RecognitionProtocol(
        dataset,
        _unseen(dataset, arguments.unseen),
        methods,
        arguments.tracking,
        pythons,
        (RECORDED, *lights.values()),
    )
    with progress_bar("participants", len(protocol.unseen)) as advance:
        trials = evaluate_recognition(protocol, usable_cores(), advance)
    result = summarise_recognition([trial for trial in trials if trial.light == RECORDED])
    grids = recognition_grids(result)
    if lights:
        by_light = {
            name: summarise_recognition([trial for trial in trials if trial.light == light])
            for name, light in lights.items()
        }
        grids.append(light_grid({"as recorded": result, **by_light}))
        result = {**result, "lights": by_light}
    return result, grids


def _light(name: str) -> Light:
    """Read factors on red, green and blue; raises SettingsError."""
    try:
        red, green, blue = (float(factor) for factor in name.split(","))
    except ValueError:
        red = green = blue = 0.0
    if not all(0.0 < factor < math.inf for factor in (red, green, blue)):
        raise SettingsError(
            f"--light {name}: not three factors above 0 on red, green and blue, as 0.85,1,1.15"
        )
    return red, green, blue


def _alone(dataset: Dataset, report: Path | None) -> tuple[dict[str, Any], list[Grid]]:
    participants = {entry.participant for entry in dataset.entries}
    with progress_bar("participants", len(participants)) as advance:
        alone = recognise_alone(dataset, usable_cores(), advance)
    summary = alone.summary()
    if report is not None:
        # Matplotlib is loaded only where a report is drawn.
        from inhand_lab.recognition.confusion_picture import draw_confusions

        draw_confusions(_confusions(alone), alone.actions, report / "confusion.png")
    rows = tuple((key.replace("_", " "), f"{value:.1f}") for key, value in summary.items())
    grid = Grid("recognised right, people left out", ("of", "%"), rows)
    matrices = {title: matrix.tolist() for title, matrix in _confusions(alone).items()}
    return {**summary, "actions": alone.actions, "confusion": matrices}, [grid]


def _on_others(
    dataset: Dataset, arguments: argparse.Namespace
) -> tuple[dict[str, Any], list[Grid]]:
    others = load_dataset(arguments.test_on)
    never_trained = None if arguments.others is None else load_dataset(arguments.others)
    taught_by = [name for name in arguments.taught_by.split(",") if name]
    with progress_bar("lessons", transfer_steps(dataset, others)) as advance:
        counts = recognise_others(
            dataset, others, taught_by, never_trained, usable_cores(), advance
        )
    return {"counts": [asdict(count) for count in counts]}, [known_frames_grid(counts)]


def _confusions(alone: RecognitionAlone) -> dict[str, Any]:
    return {
        "sequences": alone.confusion(sequences=True),
        "frames": alone.confusion(sequences=False),
    }


def _false_objects(
    dataset: Dataset, arguments: argparse.Namespace
) -> tuple[dict[str, Any], list[Grid]]:
    others = None if arguments.others is None else load_dataset(arguments.others)
    protocol = FalseObjectProtocol(
        dataset, others, _unseen(dataset, arguments.unseen), DEFAULT_RECOGNITION_EVALUATION
    )
    if has_images(dataset):
        with progress_bar("participants", len(protocol.unseen)) as advance:
            counted = count_with_images(protocol, usable_cores(), advance)
    else:
        with progress_bar("actions", 1 + len(dataset.interactions())) as advance:
            counted = count_by_movement(protocol, usable_cores(), advance)
    result = {
        "images": counted.images,
        "others_images": counted.others_images,
        "nothing_in_use": counted.idle,
        "others": counted.others,
        "never_trained": counted.never_trained,
    }
    return dict(result), [false_object_grid(counted)]


def _unseen(dataset: Dataset, chosen: str | None) -> tuple[str, ...]:
    participants = sorted({entry.participant for entry in labelled_entries(dataset)})
    unseen = participants[:2] if chosen is None else chosen.split(",")
    if unknown := [name for name in unseen if name not in participants]:
        raise SettingsError(f"no participant {unknown[0]!r}; there are: {', '.join(participants)}")
    return tuple(unseen)
