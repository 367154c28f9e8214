"""Says how frames and estimated skeletons flow on a host that is busy.

``python tests/scenes/busy_skeletons.py``: a camera whose pictures were drawn before, at 30 frames
a second, is captured with estimated skeletons, beside nothing and beside a busy loop on each core,
also with faces hidden, and with the simulator, which draws as well, in place of the camera. A line
each: frames and skeletons a second, their ages as they reach this process, milliseconds, and how
many cores capture took. Exit code 1 where a camera's frames come at less than 29 a second, or
skeletons at less than 14, beside the busy loops.
"""

import argparse
import os
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import psutil
from inhand_runtime.inbox import Received
from inhand_schemas.topics import RGBD, SKELETONS, AnyTopic
from plugins import install_plugins
from running_rig import RunningRig, eventually
from wire import Wire

SETTLES_S = 5.0
LEAST_FRAMES, LEAST_SKELETONS = 29.0, 14.0
FACES = "mask_faces = true"


@dataclass(frozen=True)
class Row:
    """What was seen in one case: rates a second, ages in milliseconds (p50, p99)."""

    case: str
    frames: float
    frame_ages: tuple[float, float]
    skeletons: float
    skeleton_ages: tuple[float, float]
    cores: float

    def line(self) -> str:
        """The row of the table."""
        frame_ages, skeleton_ages = (
            " | ".join(f"{age:.0f}" for age in ages)
            for ages in (self.frame_ages, self.skeleton_ages)
        )
        return (
            f"| {self.case} | {self.frames:.1f} | {frame_ages} | {self.skeletons:.1f} | "
            f"{skeleton_ages} | {self.cores:.2f} |"
        )


TITLE = """| | frames/s | p50 | p99 | skeletons/s | p50 | p99 | cores |
|---|---|---|---|---|---|---|---|"""


def measured(rig: RunningRig, case: str, source: str, more: str, seconds: float) -> Row:
    """Capture for a while and look at what comes."""
    rig.configure(f'[capture.front]\nsource = "{source}"\nskeletons = "estimated"\n{more}')
    with Wire.at(rig.meeting) as wire:
        heard = {topic: wire.hear(topic) for topic in (RGBD, SKELETONS)}
        daemon = rig.python(
            *("-m", "inhand_capture", "--config", rig.config),
            PYTHONPATH=str(rig.folder / "plugins"),
        )
        for topic, received in heard.items():
            eventually(topic.stream, lambda received=received: received)
        time.sleep(SETTLES_S)
        used = sum(psutil.Process(daemon.pid).cpu_times()[:2])
        begin_ns = time.time_ns()
        time.sleep(seconds)
        end_ns = time.time_ns()
        used = sum(psutil.Process(daemon.pid).cpu_times()[:2]) - used
        daemon.stop()
    counts, ages = zip(
        *(_seen(topic, received, begin_ns, end_ns) for topic, received in heard.items()),
        strict=True,
    )
    frames, skeletons = (count / seconds for count in counts)
    return Row(case, frames, ages[0], skeletons, ages[1], used / seconds)


def _seen(
    topic: AnyTopic, received: Sequence[Received], begin_ns: int, end_ns: int
) -> tuple[int, tuple[float, float]]:
    """Return how many messages came in a time, and how old they were."""
    within = [one for one in received if begin_ns <= one.received_ns < end_ns]
    ages = [(one.received_ns - topic.decode(one.payload).time_ns) / 1e6 for one in within]
    p50, p99 = np.percentile(ages, (50, 99)).tolist()
    return len(within), (p50, p99)


def main() -> int:
    """Run every case once."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=30.0)
    chosen = parser.parse_args()
    late = []
    with tempfile.TemporaryDirectory() as folder:
        rig = RunningRig(Path(folder))
        install_plugins(rig.folder / "plugins")
        try:
            print(TITLE, flush=True)
            for source, name, more in (
                ("drawn", "a camera", ""),
                ("drawn", "a camera, faces hidden", FACES),
                ("simulator", "the simulator", ""),
            ):
                quiet = measured(rig, f"{name}, nothing beside it", source, more, chosen.seconds)
                print(quiet.line(), flush=True)
                loops = [rig.python("-c", "while True: pass") for _ in os.sched_getaffinity(0)]
                busy = measured(rig, f"{name}, a busy host", source, more, chosen.seconds)
                print(busy.line(), flush=True)
                for loop in loops:
                    loop.popen.kill()
                    loop.wait()
                if not more and source == "drawn":
                    late += _late(busy)
        finally:
            rig.close()
    for line in late:
        print(f"WRONG: {line}")
    return 1 if late else 0


def _late(row: Row) -> list[str]:
    """What of a row breaks the promise."""
    lines = []
    if row.frames < LEAST_FRAMES:
        lines.append(f"{row.case}: {row.frames:.1f} frames a second")
    if row.skeletons < LEAST_SKELETONS:
        lines.append(f"{row.case}: {row.skeletons:.1f} skeletons a second")
    return lines


if __name__ == "__main__":
    sys.exit(main())
