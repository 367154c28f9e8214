"""Writes the folder of an evaluation's report: tables, sequences, and the paper's figures.

``report.md`` shows all of it; ``table.txt``, ``evaluation.json`` and ``sequences.tsv`` are for
terminals, programs and spreadsheets.
"""

import json
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from inhand_runtime.errors import InhandError
from inhand_tracker.model.model import Model
from rich.console import Console

from inhand_lab.datasets.labelled_sequence import labelled_sequence
from inhand_lab.datasets.observations import track_together
from inhand_lab.datasets.stretches import entry_frames
from inhand_lab.evaluation.folds import Fold
from inhand_lab.evaluation.protocol import Candidate, Protocol, Trial
from inhand_lab.evaluation.published import REFERENCE_METHOD
from inhand_lab.report.markdown_report import markdown, report_grids
from inhand_lab.report.part_measures import part_measures
from inhand_lab.report.sequences_file import tab_separated
from inhand_lab.workers import in_processes

FIGURE_SUFFIXES = {"spread": ".png", "rotation": ".png", "translation": ".png", "frames": ".jpg"}


@dataclass(frozen=True)
class _Drawing:
    """The task to draw one fold's figures into a folder."""

    folder: Path
    protocol: Protocol
    fold: Fold


def prepare_report_folder(folder: Path) -> None:
    """Make the folder before the hours of work whose report it will hold; raises InhandError."""
    with _reporting(folder):
        folder.mkdir(parents=True, exist_ok=True)


def write_report(
    folder: Path,
    protocol: Protocol,
    trials: Sequence[Trial],
    result: Mapping[str, Any],
    processes: int,
    on_progress: Callable[[], None] = lambda: None,
) -> None:
    """Fill a folder that exists; ``on_progress`` is called once an interaction.

    One fold of each interaction is drawn, going on to the next participant with each, as the paper
    does. Raises InhandError.
    """
    with _reporting(folder):
        (folder / "evaluation.json").write_text(json.dumps(result, indent=2) + "\n")
        (folder / "sequences.tsv").write_text(tab_separated(trials), encoding="utf-8")
        with (folder / "table.txt").open("w", encoding="utf-8") as file:
            console = Console(file=file, width=100)
            for grid in report_grids(result):
                console.print(grid.for_terminal(), "")
        shown = _shown(protocol.folds)
        tasks = [_Drawing(folder, protocol, fold) for fold in shown]
        drawn = in_processes(_draw, tasks, processes, lambda _: on_progress())
        files = {fold.interaction: names for fold, names in zip(shown, drawn, strict=True)}
        (folder / "report.md").write_text(markdown(result, files), encoding="utf-8")


def _shown(folds: Sequence[Fold]) -> list[Fold]:
    """Choose one fold of each interaction."""
    by_interaction: dict[str, list[Fold]] = {}
    for fold in folds:
        by_interaction.setdefault(fold.interaction, []).append(fold)
    return [of_one[number % len(of_one)] for number, of_one in enumerate(by_interaction.values())]


def _draw(task: _Drawing) -> list[str]:
    """Draw the figures of a fold, and return the names of their files."""
    # Matplotlib is loaded only where a report is drawn.
    from inhand_lab.report.plots import plot_rotation_stability, plot_spread, plot_translation

    protocol, fold = task.protocol, task.fold
    model = protocol.learn(fold, images=bool(protocol.terms[0]))
    files = {
        name: task.folder / f"{name}_{_slug(fold.interaction)}{suffix}"
        for name, suffix in FIGURE_SUFFIXES.items()
    }
    learned = fold.trained[0]
    measures = part_measures(model.mapping, 0)
    title = f"{fold.interaction}, participant {learned.participant}"
    frame_rate = labelled_sequence(protocol.trained, learned).frame_rate
    plot_spread(measures, frame_rate, title, files["spread"])
    plot_rotation_stability(measures, frame_rate, title, files["rotation"])
    plot_translation(measures, frame_rate, title, files["translation"])
    if not _draw_frames(task, model, files["frames"]):
        del files["frames"]
    return [file.name for file in files.values()]


def _draw_frames(task: _Drawing, model: Model, file: Path) -> bool:
    from inhand_lab.report.tracked_frames import TrackedRecording, draw_tracked_frames

    protocol, entry = task.protocol, task.fold.tested[0]
    method = REFERENCE_METHOD if REFERENCE_METHOD in protocol.methods else protocol.methods[-1]
    candidate = Candidate(method, protocol.terms[0])
    tracker = candidate.new_tracker(model, entry)
    path = protocol.tested.path(entry)
    frames = entry_frames(protocol.tested, entry)
    joints, (track,) = track_together([tracker], path, frames, candidate.needs())
    title = f"{entry.interaction}, participant {entry.participant}, {method}"
    return draw_tracked_frames(
        TrackedRecording(path, frames, joints, track), model.shape, title, file
    )


def _slug(interaction: str) -> str:
    """Return an interaction's name as it can stand in a file's."""
    return re.sub(r"\W+", "_", interaction)


@contextmanager
def _reporting(folder: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise InhandError(f"cannot write {folder}: {error.strerror}; choose another") from None
