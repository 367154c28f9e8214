"""``inhand train``: learn where an object is from how people move with it."""

import argparse
from pathlib import Path

import numpy as np
from inhand_lab.dataset import load_dataset
from inhand_lab.training import entries_for, train
from inhand_tracker.model_file import Model, save_model
from rich.console import Console
from rich.table import Table


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument("dataset", type=Path, metavar="DATASET", help="a dataset's folder")
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="MODEL")
    parser.add_argument("--object", metavar="O", help="which one, where there are several")
    parser.add_argument(
        "--without",
        action="append",
        default=[],
        metavar="PARTICIPANT",
        help="leave a participant out; may be given again",
    )


def run(arguments: argparse.Namespace) -> int:
    """Train and save; raises DatasetError or InhandError."""
    dataset = load_dataset(arguments.dataset)
    entries = entries_for(dataset, arguments.object, arguments.without)
    console = Console()
    with Console(stderr=True).status(f"learning from {len(entries)} recordings"):
        model = train(dataset, entries)
        save_model(model, arguments.output)
    console.print(_summary(model))
    console.print(f"saved {arguments.output}")
    return 0


def _summary(model: Model) -> Table:
    mapping = model.mapping
    table = Table("learned", "value", title=f"{model.shape.name}, {model.interaction}")
    table.add_row("recordings", str(len(mapping.participants)))
    table.add_row("participants", str(len(set(mapping.participants))))
    table.add_row("labelled frames", str(len(mapping.body_poses)))
    table.add_row("cluster radius, body heights", f"{np.median(mapping.radii):.3f}")
    return table
