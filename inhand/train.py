"""``inhand train``: learns where an object is from how people move with it."""

import argparse
import logging
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from inhand_lab.datasets.dataset import Dataset, DatasetEntry, load_dataset
from inhand_lab.datasets.joint_names import named_joints
from inhand_lab.datasets.stretches import stretches_note
from inhand_lab.training.model_adaptation import adapt
from inhand_lab.training.model_summary import summarise_model
from inhand_lab.training.model_training import (
    entries_for,
    model_stages,
    recordings_of,
    train,
)
from inhand_lab.training.presence_training import learn_presence
from inhand_lab.training.recogniser_training import recogniser_stages, train_recogniser
from inhand_lab.workers import working
from inhand_runtime.errors import SettingsError
from inhand_runtime.exit_codes import DONE, FAILED
from inhand_runtime.wording import counted
from inhand_tracker.model.model import Model
from inhand_tracker.model.model_file import load_model, save_model
from inhand_tracker.recognition.recogniser_file import save_recogniser
from rich.console import Console
from rich.table import Table

from inhand.cluster import add_cluster_option, work_path
from inhand.progress import add_progress_option, progress_bars

log = logging.getLogger(__name__)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument("dataset", type=Path, metavar="DATASET", help="a dataset's folder")
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="MODEL")
    parser.add_argument(
        "--from",
        dest="start",
        type=Path,
        metavar="MODEL",
        help="adapt a model, of simulated people say, by the dataset's recordings: one is enough",
    )
    parser.add_argument("--object", metavar="O", help="which one, where there are several")
    parser.add_argument(
        "--without",
        action="append",
        default=[],
        metavar="PARTICIPANT",
        help="leave a participant out; may be given again",
    )
    parser.add_argument(
        "--recogniser",
        action="store_true",
        help="learn to tell all the dataset's interactions apart, for objects that are not given",
    )
    parser.add_argument(
        "--models",
        nargs="+",
        type=Path,
        default=[],
        metavar="MODEL",
        help="with --recogniser: learn from the dataset's images how each object is seen",
    )
    add_cluster_option(parser)
    add_progress_option(parser)


def run(arguments: argparse.Namespace) -> int:
    """Train and save; raises DatasetError or InhandError."""
    dataset = load_dataset(work_path(arguments, arguments.dataset))
    if arguments.models and not arguments.recogniser:
        raise SettingsError("--models is for --recogniser: a model is learned by itself")
    if arguments.start is not None and arguments.recogniser:
        raise SettingsError("--from adapts a model of one object: leave --recogniser out")
    if arguments.recogniser:
        return _train_recogniser(dataset, arguments)
    start = None if arguments.start is None else load_model(arguments.start)
    choose = entries_for if start is None else recordings_of
    entries = choose(dataset, arguments.object, arguments.without)
    stages = {**model_stages(len(entries), start), "saving": 1}
    refused: dict[DatasetEntry, Exception] = {}
    with (
        working(arguments.cluster),
        progress_bars(stages, lines=arguments.progress_lines) as advance,
    ):
        if start is None:
            model = train(dataset, entries, advance, refused.__setitem__)
        else:
            model = adapt(start, dataset, entries, advance, refused.__setitem__)
        save_model(model, arguments.output)
        advance("saving")
    console = Console()
    console.print(_summary(model))
    if absent := model.mapping.absent_joints:
        console.print(f"left out, as no recording shows them: {named_joints(absent)}")
    if note := stretches_note(entries):
        console.print(note)
    console.print(f"saved {arguments.output}: {arguments.output.stat().st_size / 1e6:.1f} MB")
    return _report_refused(list(refused.values()), len(entries))


def _report_refused(refused: Sequence[Exception], recordings: int) -> int:
    """Name the recordings that were passed over; return the exit code."""
    for error in refused:
        log.warning("%s", error)
    if refused:
        log.warning(
            "%d of %s passed over, and the model is learned from the others",
            len(refused),
            counted(recordings, "recording"),
        )
    return FAILED if refused else DONE


def _train_recogniser(dataset: Dataset, arguments: argparse.Namespace) -> int:
    if arguments.object is not None:
        raise SettingsError("--recogniser learns all interactions: leave --object out")
    participants = {entry.participant for entry in dataset.entries}
    if unknown := sorted(set(arguments.without) - participants):
        raise SettingsError(
            f"no participant {unknown[0]!r}; there are: {', '.join(sorted(participants))}"
        )
    entries = [entry for entry in dataset.entries if entry.participant not in arguments.without]
    stages = {**recogniser_stages(len(entries)), "saving": 1}
    refused: dict[DatasetEntry, Exception] = {}
    with progress_bars(stages, lines=arguments.progress_lines) as advance:
        recogniser = train_recogniser(dataset, entries, advance, refused.__setitem__)
        if arguments.models:
            models = _models_of(recogniser.actions, arguments.models)
            read = [entry for entry in entries if entry not in refused]
            presence = learn_presence(dataset, read, recogniser.actions, models)
            recogniser = replace(recogniser, presence=presence)
        save_recogniser(recogniser, arguments.output)
        advance("saving")
    console = Console()
    console.print(f"learned to recognise {', '.join(recogniser.actions)}")
    console.print(f"saved {arguments.output}: {arguments.output.stat().st_size / 1e6:.1f} MB")
    return _report_refused(list(refused.values()), len(entries))


def _models_of(actions: Sequence[str], files: Sequence[Path]) -> list[Model]:
    by_action = {model.interaction: model for model in map(load_model, files)}
    if missing := [action for action in actions if action not in by_action]:
        raise SettingsError(f"--models has none of {missing[0]!r}: name one for each interaction")
    return [by_action[action] for action in actions]


def _summary(model: Model) -> Table:
    learned = summarise_model(model.mapping)
    least, median, greatest = learned.radii
    table = Table("learned", "value", title=f"{model.shape.name}, {model.interaction}")
    table.add_row("recordings", str(learned.recordings))
    table.add_row("participants", str(learned.participants))
    table.add_row("frames", str(learned.frames))
    table.add_row("cluster radii, body heights", f"{median:.3f} ({least:.3f} to {greatest:.3f})")
    table.add_row("frames good to re-initialise rotation", f"{learned.good_rotations:.0%}")
    table.add_row("frames good to re-initialise translation", f"{learned.good_translations:.0%}")
    table.add_row("translation mostly predicted from", _part(learned.translation_part))
    table.add_row("rotation mostly predicted from", _part(learned.rotation_part))
    return table


def _part(part: tuple[str, float]) -> str:
    name, share = part
    return f"{name}, in {share:.0%} of frames"
