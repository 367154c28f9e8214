"""``inhand record``: makes a training recording of a running rig and adds it to a dataset."""

import argparse
import os
import sys
from pathlib import Path

from inhand_lab.datasets.dataset import DatasetEntry, DatasetError, load_dataset
from inhand_lab.datasets.new_entry import add_entry
from inhand_runtime.errors import InhandError, SettingsError
from inhand_runtime.exit_codes import DONE
from inhand_runtime.wording import counted
from inhand_runtime.writable import require_writable_folder

from inhand.looking import add_looking_arguments, open_look, positive_number
from inhand.results import write_json
from inhand.take import Take, TakeWishes, take

COUNTDOWN_S = 5.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    add_looking_arguments(parser, None, "to record")
    parser.add_argument("--dataset", type=Path, required=True, metavar="FOLDER", help="where to")
    parser.add_argument("--participant", required=True, metavar="NAME", help="who is recorded")
    parser.add_argument("--left-handed", action="store_true", help="that person is left-handed")
    parser.add_argument("--interaction", required=True, metavar="NAME", help="what is done")
    parser.add_argument("--object", metavar="NAME", help="which object of the dataset is used")
    parser.add_argument("--camera", metavar="NAME", help="which camera, where there are several")
    parser.add_argument(
        "--countdown",
        type=positive_number,
        default=COUNTDOWN_S,
        metavar="S",
        help=f"seconds to walk into the picture (default: {COUNTDOWN_S:g})",
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the result for machines")


def run(arguments: argparse.Namespace) -> int:
    """Record until the time is up or Ctrl-C, and add the entry."""
    folder: Path = arguments.dataset
    _check(folder, arguments)
    wishes = TakeWishes(
        folder / "recordings", arguments.camera, arguments.countdown, arguments.seconds
    )
    with open_look(arguments.config) as look:
        done = take(look, wishes, _say)
    entry = DatasetEntry(
        file=f"recordings/{done.path.name}",
        interaction=arguments.interaction,
        participant=arguments.participant,
        object=arguments.object,
        handedness="left" if arguments.left_handed else "right",
    )
    try:
        add_entry(folder, entry)
    except DatasetError as error:
        raise InhandError(f"{done.path} is whole, but not in the dataset: {error}") from None
    _report(done)
    if arguments.json is not None:
        write_json(arguments.json, _result(done))
    return DONE


def _check(folder: Path, arguments: argparse.Namespace) -> None:
    """Refuse before the countdown what could not be written or learned from after it."""
    for option in ("participant", "interaction"):
        if not getattr(arguments, option).strip():
            raise SettingsError(f"--{option} is empty: give it a name")
    require_writable_folder(folder)
    require_writable_folder(folder / "recordings")
    if (folder / "dataset.toml").exists():
        load_dataset(folder)
    name = arguments.object
    if name is not None and not (folder / "objects" / name / "object.toml").is_file():
        raise SettingsError(
            f"{folder} has no object {name!r}: make it by `inhand object new {name} --dataset "
            f"{folder}`, or leave --object out"
        )


def _say(line: str) -> None:
    """Print a line as long as anybody reads; where nobody does, the recording goes on."""
    try:
        print(line, flush=True)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _report(done: Take) -> None:
    _say(
        f"{done.path}: {done.seconds:.1f} s, {counted(done.frames, 'picture')}, "
        f"{counted(done.skeletons, 'skeleton')}, {done.lost} lost"
    )
    for kind, share in done.missing.items():
        _say(f"  {kind}: missing in {share:.0%} of it")


def _result(done: Take) -> dict[str, object]:
    return {
        "recording": str(done.path),
        "camera": done.camera,
        "seconds": done.seconds,
        "frames": done.frames,
        "skeletons": done.skeletons,
        "lost": done.lost,
        "missing": done.missing,
    }
