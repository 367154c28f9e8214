"""``inhand replay``: publish recordings again, with their original timing and capture times."""

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from inhand_capture.service import run as run_capture
from inhand_capture.settings import CaptureSettings
from inhand_capture.sources.replay_files import named
from inhand_runtime.errors import SettingsError
from inhand_runtime.recording import RecordingError, read_recording
from inhand_runtime.settings import Settings, load_rig_file
from inhand_schemas.errors import KeyFormatError
from inhand_schemas.keys import Site
from inhand_schemas.topics import INFO

from inhand.looking import camera_name
from inhand.replay_terminal import playing_on_terminal

CAMERA = "camera/"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument(
        "files", type=Path, nargs="+", metavar="RECORDING", help="several are played as one"
    )
    parser.add_argument(
        "--rate", type=_rate, default=1.0, metavar="R", help="2 = twice as fast, 0 = no pauses"
    )
    parser.add_argument("--loop", action="store_true", help="begin again at the end")
    parser.add_argument("--camera", metavar="NAME", help="which one of a recording of several")
    parser.add_argument(
        "--start", metavar="T", help="seconds from the begin, or a time (2026-11-29T20:17:53Z)"
    )
    parser.add_argument("--until", metavar="T", help="the same, where it ends")
    parser.add_argument("--paused", action="store_true", help="wait for somebody to resume it")
    parser.add_argument(
        "--times",
        choices=("original", "now"),
        default="original",
        help="the capture times that are published (default: original)",
    )
    parser.add_argument(
        "--include",
        action="append",
        metavar="STREAM/NAME",
        help="play only this, * for any; may be given again (default: all that is played)",
    )
    parser.add_argument(
        "--exclude", action="append", metavar="STREAM/NAME", help="do not play this, * for any"
    )
    parser.add_argument(
        "--remap",
        type=_renaming,
        action="append",
        default=[],
        metavar="camera/OLD=NEW",
        help="publish it as the camera NEW; object/OLD=NEW: its labels as of the object NEW",
    )
    parser.add_argument("--config", type=Path, metavar="FILE", help="the rig's settings (TOML)")


def run(arguments: argparse.Namespace) -> int:
    """Publish until the end, SIGTERM or Ctrl-C; raises InhandError."""
    rig_file = load_rig_file(arguments.config)
    camera = _camera(arguments.files, arguments.camera)
    cameras = {old: new for old, new in arguments.remap if old.startswith(CAMERA)}
    instance = cameras.pop(CAMERA + camera, camera)
    if cameras:
        raise SettingsError(f"--remap {next(iter(cameras))} names no camera that is replayed")
    settings = Settings(
        site=Site(rig_file.realm, rig_file.rig),
        zenoh=rig_file.zenoh,
        log=rig_file.log,
        instance=instance,
        service=CaptureSettings(source="replay", options=_options(arguments, camera)),
    )
    with playing_on_terminal(arguments.config, instance, named(arguments.files)):
        run_capture(settings)
    return 0


def _options(arguments: argparse.Namespace, camera: str) -> dict[str, Any]:
    """The options of the source, without those that were not given."""
    wishes = {
        "file": tuple(arguments.files),
        "rate": arguments.rate,
        "loop": arguments.loop,
        "camera": camera,
        "start": arguments.start,
        "until": arguments.until,
        "paused": arguments.paused,
        "times": arguments.times,
        "include": arguments.include,
        "exclude": arguments.exclude,
        "remap": {old: new for old, new in arguments.remap if not old.startswith(CAMERA)},
    }
    return {name: wish for name, wish in wishes.items() if wish is not None}


def _rate(text: str) -> float:
    try:
        rate = float(text)
    except ValueError:
        rate = -1.0
    if not 0 <= rate < float("inf"):
        raise argparse.ArgumentTypeError(f"write a number, 0 or more, not {text!r}")
    return rate


def _renaming(text: str) -> tuple[str, str]:
    old, equals, new = text.partition("=")
    if not equals or not old.startswith((CAMERA, "object/")):
        raise argparse.ArgumentTypeError(f"write camera/OLD=NEW or object/OLD=NEW, not {text!r}")
    return old, camera_name(new) if old.startswith(CAMERA) else new


def _camera(recordings: Sequence[Path], wish: str | None) -> str:
    cameras: set[str] = set()
    for path in recordings:
        try:
            cameras |= {message.name for message in read_recording(path, streams=(INFO.stream,))}
        except KeyFormatError as error:
            raise RecordingError(f"{path}: {error}") from None
    names, files = ", ".join(sorted(cameras)), named(recordings)
    if not cameras:
        raise RecordingError(f"{files} holds no camera's info: choose another recording")
    if wish is None and len(cameras) > 1:
        raise SettingsError(f"{files} holds several cameras; add --camera with one of: {names}")
    if wish is not None and wish not in cameras:
        raise SettingsError(f"{files} holds no camera {wish!r}; there are: {names}")
    return wish or cameras.pop()
