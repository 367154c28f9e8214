"""``inhand demo``: from nothing to tracked, recorded object poses on this machine."""

import argparse
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
from inhand_capture.estimation.networks import require_network
from inhand_capture.estimation.weights import DEFAULT_NETWORK
from inhand_lab.demonstration.parameters import DEFAULT_DEMONSTRATION
from inhand_lab.demonstration.preparation import train_demonstration, write_rig_file
from inhand_lab.demonstration.review import Review, review
from inhand_lab.demonstration.typical_frame import draw_typical_frame
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.parameters import RIG_CAMERAS
from inhand_runtime.errors import InhandError, SettingsError
from inhand_runtime.supervisor_watch import supervised
from inhand_runtime.wording import counted
from inhand_schemas.topics import POSE, SKELETONS
from rich.console import Console
from rich.progress import Progress, TextColumn, TimeElapsedColumn
from rich.table import Table

from inhand.looking import Look, open_look
from inhand.progress import progress_bar
from inhand.results import write_json

DEFAULT_INTERACTION = "drinkFromMug"
DEFAULT_SECONDS = 12.0
READY_WITHIN_S = 120.0
"""Seconds until the first pose, at the most: a tracker's first start compiles its loops, and that
took more than a minute on two cores with twenty processes."""
ERROR_BOUND_CM = 12.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument(
        "--interaction",
        default=DEFAULT_INTERACTION,
        choices=INTERACTIONS,
        help=f"what the simulated person does (default: {DEFAULT_INTERACTION})",
    )
    parser.add_argument(
        "--seconds", type=float, default=DEFAULT_SECONDS, metavar="S", help="how long to track"
    )
    parser.add_argument(
        "--cameras",
        type=int,
        default=1,
        metavar="N",
        help="so many see the person, who walks about where the hands allow it, 1 to "
        f"{len(RIG_CAMERAS)} (default: 1)",
    )
    parser.add_argument(
        "--camera-like",
        action="store_true",
        help="as with a real camera: find the person in the pictures (`inhand models fetch` first)",
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the result")
    parser.add_argument(
        "--folder", type=Path, default=Path("demo"), metavar="DIR", help="where to keep everything"
    )


def run(arguments: argparse.Namespace) -> int:
    """Exit code 1 when a frame was lost or the error is beyond the bound."""
    if not 1 <= arguments.seconds <= 3600:
        raise SettingsError("--seconds is 1 to 3600")
    if not 1 <= arguments.cameras <= len(RIG_CAMERAS):
        raise SettingsError(f"--cameras is 1 to {len(RIG_CAMERAS)}")
    if arguments.camera_like:
        require_network(DEFAULT_NETWORK)
    began = time.monotonic()
    console = Console()
    folder = arguments.folder / time.strftime("%Y%m%d_%H%M%S")
    folder.mkdir(parents=True)
    with progress_bar(
        "simulating people to learn from", DEFAULT_DEMONSTRATION.trained_participants
    ) as advance:
        model, model_path = train_demonstration(folder, arguments.interaction, advance)
    config = write_rig_file(
        folder.resolve(),
        arguments.interaction,
        model_path.resolve(),
        "estimated" if arguments.camera_like else "source",
        arguments.cameras,
    )
    _run_rig(config, arguments.seconds)
    recording = _only_recording(folder / "recordings")
    seen = review(recording, model.shape.name, model.shape.marked_vertices)
    if len(seen.vertex_errors_m) == 0:
        raise InhandError(f"{recording} holds no pose that can be compared with the truth")
    picture = folder / "picture.png"
    draw_typical_frame(recording, seen, model.shape, picture)
    result = _result(seen, recording, picture, time.monotonic() - began)
    console.print(_table(seen))
    for line in _summary(result):
        console.print(line, soft_wrap=True)
    if arguments.json is not None:
        write_json(arguments.json, result)
    return _judge(result)


def _run_rig(config: Path, seconds: float) -> None:
    """Cameras, tracker and recorder as processes, for some seconds from the first pose on."""
    command = [sys.executable, "-m", "inhand", "up", "--config", str(config)]
    with open_look(config) as look:
        look.follow(POSE)
        rig = subprocess.Popen(
            command, env={**os.environ, **supervised()}, stdin=subprocess.DEVNULL
        )
        try:
            _watch(look, rig, seconds)
        finally:
            rig.send_signal(signal.SIGTERM)
            code = rig.wait()
    if code != 0:
        raise InhandError("the rig did not run as it should; the lines above say why")


def _watch(look: Look, rig: subprocess.Popen[bytes], seconds: float) -> None:
    """Show the poses as they come, for some seconds from the first one on."""
    console = Console(stderr=True)
    columns = (TextColumn("{task.description}"), TimeElapsedColumn())
    with Progress(*columns, console=console, transient=True) as progress:
        task = progress.add_task("waiting for the first pose")
        poses = 0
        end = time.monotonic() + READY_WITHIN_S
        for sample in look.samples(None):
            if time.monotonic() > end or rig.poll() is not None:
                break
            if sample is None:
                continue
            if poses == 0:
                end = time.monotonic() + seconds
            poses += 1
            pose = POSE.decode(sample.payload)
            if pose.camera_from_object is not None:
                x, y, z = pose.camera_from_object.translation
                progress.update(
                    task,
                    description=f"{pose.object} {pose.state}, {counted(poses, 'pose')}, "
                    f"at x {x:+.2f} y {y:+.2f} z {z:+.2f} m, confidence {pose.confidence:.2f}",
                )
    if poses == 0:
        raise InhandError(f"no pose came within {READY_WITHIN_S:.0f} s; the lines above say why")


def _only_recording(folder: Path) -> Path:
    found = sorted(folder.glob("*.mcap"))
    if not found:
        raise InhandError(f"the recorder left no recording in {folder}")
    return found[0]


def _result(seen: Review, recording: Path, picture: Path, seconds: float) -> dict[str, Any]:
    p50, p99 = np.percentile(seen.latencies_ms, (50, 99)).tolist()
    return {
        "topics": {
            stream: {
                "published": one.published,
                "received": one.received,
                "recorded": one.recorded,
                "lost": one.lost,
            }
            for stream, one in seen.traffic.items()
        },
        "latency_ms": {"p50": p50, "p99": p99},
        "skipped_frames": seen.skipped_frames,
        "vertex_error_cm": 100.0 * float(seen.vertex_errors_m.mean()),
        "recording": str(recording),
        "picture": str(picture),
        "seconds": seconds,
    }


def _table(seen: Review) -> Table:
    table = Table(
        "topic", "published", "received", "recorded", "lost", title="from capture to recorder"
    )
    for stream, one in seen.traffic.items():
        counts = (one.published, one.received, one.recorded, one.lost)
        table.add_row(stream, *map(str, counts))
    return table


def _summary(result: dict[str, Any]) -> list[str]:
    latency = result["latency_ms"]
    frames = result["topics"].get(SKELETONS.stream, {"published": 0})["published"]
    return [
        f"frames that the tracker left out because newer ones had come: {result['skipped_frames']} "
        f"of {frames}",
        f"latency, capture to pose: p50 {latency['p50']:.1f} ms, p99 {latency['p99']:.1f} ms",
        f"vertex error for a person never seen before: {result['vertex_error_cm']:.1f} cm "
        f"(bound {ERROR_BOUND_CM:.0f} cm)",
        f"recording: {result['recording']}",
        f"picture:   {result['picture']}",
    ]


def _judge(result: dict[str, Any]) -> int:
    lost = sum(topic["lost"] for topic in result["topics"].values())
    if lost:
        print(f"inhand demo: lost {counted(lost, 'message')}", file=sys.stderr)
    if result["vertex_error_cm"] > ERROR_BOUND_CM:
        print("inhand demo: the error is beyond its bound", file=sys.stderr)
    return int(lost > 0 or result["vertex_error_cm"] > ERROR_BOUND_CM)
