"""``inhand replay``: publish a recording again, with its original timing and capture times."""

import argparse
import contextlib
import threading
from collections.abc import Iterator
from pathlib import Path

from inhand_capture.service import run as run_capture
from inhand_capture.settings import CaptureSettings
from inhand_runtime.errors import SettingsError
from inhand_runtime.recording import RecordingError, read_recording
from inhand_runtime.settings import Settings, load_rig_file
from inhand_schemas.errors import KeyFormatError
from inhand_schemas.keys import Site
from inhand_schemas.topics import HEALTH, INFO
from mcap.reader import make_reader
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

from inhand.looking import open_look


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument("recording", type=Path, metavar="RECORDING")
    parser.add_argument(
        "--rate", type=_rate, default=1.0, metavar="R", help="2 = twice as fast, 0 = no pauses"
    )
    parser.add_argument("--loop", action="store_true", help="begin again at the end")
    parser.add_argument("--camera", metavar="NAME", help="which one of a recording of several")
    parser.add_argument("--config", type=Path, metavar="FILE", help="the rig's settings (TOML)")


def run(arguments: argparse.Namespace) -> int:
    """Publish until the end, SIGTERM or Ctrl-C; raises InhandError."""
    rig_file = load_rig_file(arguments.config)
    camera = _camera(arguments.recording, arguments.camera)
    options = {
        "file": arguments.recording,
        "rate": arguments.rate,
        "loop": arguments.loop,
        "camera": camera,
    }
    settings = Settings(
        site=Site(rig_file.realm, rig_file.rig),
        zenoh=rig_file.zenoh,
        log=rig_file.log,
        instance=camera,
        service=CaptureSettings(source="replay", options=options),
    )
    with _progress(arguments, camera):
        run_capture(settings)
    return 0


def _rate(text: str) -> float:
    try:
        rate = float(text)
    except ValueError:
        rate = -1.0
    if not 0 <= rate < float("inf"):
        raise argparse.ArgumentTypeError(f"write a number, 0 or more, not {text!r}")
    return rate


def _camera(recording: Path, wish: str | None) -> str:
    try:
        cameras = {message.name for message in read_recording(recording, streams=(INFO.stream,))}
    except KeyFormatError as error:
        raise RecordingError(f"{recording}: {error}") from None
    if not cameras:
        raise RecordingError(f"{recording} holds no camera's info: choose another recording")
    if wish is None and len(cameras) > 1:
        names = ", ".join(sorted(cameras))
        raise SettingsError(f"{recording} holds several cameras; add --camera with one of: {names}")
    if wish is not None and wish not in cameras:
        names = ", ".join(sorted(cameras))
        raise SettingsError(f"{recording} holds no camera {wish!r}; there are: {names}")
    return wish or cameras.pop()


@contextlib.contextmanager
def _progress(arguments: argparse.Namespace, camera: str) -> Iterator[None]:
    """A bar on a terminal: the messages of the camera's busiest key, by its health."""
    console = Console(stderr=True)
    if not console.is_terminal:
        yield
        return
    total = None if arguments.loop else _messages(arguments.recording, camera)
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn())
    ended = threading.Event()
    with Progress(*columns, console=console) as progress:
        task = progress.add_task(f"replaying {arguments.recording.name}", total=total)

        def watch() -> None:
            with open_look(arguments.config) as look:
                look.follow(HEALTH, camera)
                for sample in look.samples(None):
                    if ended.is_set():
                        return
                    if sample is not None:
                        topics = HEALTH.decode(sample.payload).topics.values()
                        published = max((topic.published for topic in topics), default=0)
                        progress.update(task, completed=published)

        watcher = threading.Thread(target=watch, name="progress")
        watcher.start()
        try:
            yield
        finally:
            ended.set()
            watcher.join()


def _messages(recording: Path, camera: str) -> int:
    with recording.open("rb") as file:
        summary = make_reader(file).get_summary()
    if summary is None or summary.statistics is None:
        return 0
    counts = summary.statistics.channel_message_counts
    return max(
        counts.get(channel.id, 0)
        for channel in summary.channels.values()
        if channel.topic.endswith(f"/{camera}")
    )
