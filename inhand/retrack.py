"""``inhand recording retrack``: track recordings again, many at once, without a rig."""

import argparse
import threading
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

from inhand_runtime.errors import SettingsError
from inhand_runtime.exit_codes import DONE
from inhand_runtime.recording.part_file import PART_SUFFIX
from inhand_runtime.settings import load_settings
from inhand_runtime.wording import counted

from inhand.cluster import add_cluster_option, work_path
from inhand.looking import camera_name, positive_count
from inhand.progress import add_progress_option, progress_bar
from inhand.results import write_json

if TYPE_CHECKING:
    from inhand.retracked import Retracked, Retracking

DEFAULT_TRACKER = "retrack"
SHOWN_BYTES = 1_000_000
"""Bytes of the new recordings that a step of the bar stands for."""
LOOK_S = 0.5
"""Seconds between two looks at how far they have grown."""


def add_action(actions: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Add the action to those of ``inhand recording``."""
    text = "track recordings again, with the new poses beside the old ones"
    action = actions.add_parser("retrack", help=text, description=text)
    action.add_argument("files", nargs="+", type=Path, metavar="RECORDING")
    by = action.add_mutually_exclusive_group(required=True)
    by.add_argument(
        "--model", dest="models", nargs="+", type=Path, metavar="MODEL", help="the objects' models"
    )
    by.add_argument(
        "--config", type=Path, metavar="FILE", help="with the settings of a tracker in this file"
    )
    action.add_argument(
        "--tracker",
        type=camera_name,
        metavar="NAME",
        help="which one of --config; new poses are named OBJECT_NAME "
        f"(default: the only one, or {DEFAULT_TRACKER})",
    )
    action.add_argument(
        "--camera",
        metavar="NAME",
        help="which one of recordings of several (default: the tracker's of --config)",
    )
    action.add_argument(
        "-o", dest="folder", type=Path, required=True, metavar="FOLDER", help="where they go"
    )
    action.add_argument(
        "--jobs", type=positive_count, metavar="N", help="so many at once (default: cores)"
    )
    add_cluster_option(action)
    action.add_argument("--json", type=Path, metavar="FILE", help="write the result there")
    add_progress_option(action)
    action.set_defaults(run_action=run)


def run(arguments: argparse.Namespace) -> int:
    """Track all that is not tracked yet; raises SettingsError, RecordingError or ModelError."""
    # What tracks is large, and no other action needs it.
    from inhand_lab.workers import in_processes, working

    from inhand.retracked import Retracked, is_done, retrack, values

    tasks = _tasks(arguments)
    arguments.folder.mkdir(parents=True, exist_ok=True)
    to_do = [task for task in tasks if not is_done(task)]
    outputs = {task.path: task.output for task in to_do}
    with (
        working(arguments.cluster) as cores,
        _growing(outputs, lines=arguments.progress_lines),
    ):
        done = in_processes(retrack, to_do, arguments.jobs or cores, apart=True)
    results = {one.path: one for one in done}
    shown = [
        results.get(task.path, Retracked(task.path, task.output, skipped=True)) for task in tasks
    ]
    for one in shown:
        print(_line(one))
        for problem, count in one.problems.items():
            print(f"  {counted(count, 'frame')}: {problem}")
    if arguments.json is not None:
        write_json(arguments.json, {"retracked": [values(one) for one in shown]})
    return DONE


def _tasks(arguments: argparse.Namespace) -> "list[Retracking]":
    """Return the work to be done; raises SettingsError before any of it."""
    from inhand_tracker.loading import load_watcher, require_files
    from inhand_tracker.model.model import ModelError
    from inhand_tracker.settings import TrackerSettings

    from inhand.retracked import Retracking, mark_of

    chosen = (
        {}
        if arguments.config
        else {"models": [str(work_path(arguments, one)) for one in arguments.models]}
    )
    config = arguments.config and work_path(arguments, arguments.config)
    name = arguments.tracker or (None if arguments.config else DEFAULT_TRACKER)
    settings = load_settings(config, "tracker", TrackerSettings, name, chosen)
    require_files(settings)
    try:
        load_watcher(settings.instance, settings.service)
    except ModelError as error:
        raise SettingsError(str(error)) from None
    if settings.service.cameras and arguments.camera is None:
        raise SettingsError(
            "recordings are tracked again by one camera, and the settings name several: choose "
            f"with --camera: {', '.join(settings.service.cameras)}"
        )
    camera = arguments.camera or (settings.service.camera if arguments.config else None)
    mark = mark_of(settings.instance, settings.service)
    outputs = _outputs(
        [work_path(arguments, path) for path in arguments.files],
        work_path(arguments, arguments.folder),
    )
    return [
        Retracking(path, output, settings.instance, settings.service, camera, mark)
        for path, output in outputs.items()
    ]


def _outputs(files: Sequence[Path], folder: Path) -> dict[Path, Path]:
    """Return where each recording goes: to its name in the folder; raises SettingsError."""
    outputs: dict[Path, Path] = {}
    for path in files:
        output = folder / path.name
        if output in outputs.values():
            raise SettingsError(f"two recordings are named {path.name}: give them two folders")
        if output.resolve() == path.resolve():
            raise SettingsError(f"{path} would be overwritten: choose another folder than its own")
        outputs[path] = output
    return outputs


@contextmanager
def _growing(outputs: Mapping[Path, Path], *, lines: bool) -> Iterator[None]:
    """Show how far recordings have grown, beside those that they are copies of, in a block."""
    total = sum(path.stat().st_size for path in outputs if path.exists()) // SHOWN_BYTES
    ended, done = threading.Event(), threading.Event()
    with progress_bar("tracking, MB", total, lines=lines) as advance:

        def watch() -> None:
            shown = 0
            while shown < total:
                over = ended.wait(LOOK_S)
                grown = min(_size(outputs.values()) // SHOWN_BYTES, total)
                grown = total if done.is_set() else grown
                for _ in range(grown - shown):
                    advance()
                shown = max(shown, grown)
                if over:
                    return

        watcher = threading.Thread(target=watch, name="progress")
        watcher.start()
        try:
            yield
            done.set()
        finally:
            ended.set()
            watcher.join()


def _size(outputs: Iterable[Path]) -> int:
    """Return the bytes of recordings that are whole or grow."""
    size = 0
    for output in outputs:
        for path in (output, output.with_name(output.name + PART_SUFFIX)):
            with suppress(FileNotFoundError):  # it is not begun, or has just got its name
                size += path.stat().st_size
    return size


def _line(one: "Retracked") -> str:
    if one.skipped:
        return f"{one.output}: there already"
    states = "; ".join(
        f"{name}: " + ", ".join(f"{count} {state}" for state, count in sorted(counts.items()))
        for name, counts in one.states.items()
    )
    frames = f"{counted(one.frames, 'frame')}, {one.with_pictures} with a picture"
    return f"{one.output}: {frames}; {states}"
