"""Lets a rig run beside a busy loop, and looks whether it grows, leaks or loses account.

``python tests/scenes/soak.py --minutes 30``: a recording with pictures is replayed over and over at
30 frames a second to a tracker and a recorder, as processes, while another process takes what it
can of the machine. Memory, file handles and threads of each are read every five seconds. Exit code
1 where memory grows by 5 MB an hour or more after the first third, a handle or thread was gained,
or a skeleton is neither used nor counted.
"""

import argparse
import json
import sys
import tempfile
import time
from collections import Counter
from dataclasses import dataclass
from functools import reduce
from operator import and_, or_
from pathlib import Path
from typing import Any

import numpy as np
import psutil
from running_rig import Process, RunningRig

PERIOD_S = 5.0
MOST_GROWTH_MB_PER_HOUR = 5.0
MOST_UNDER_WAY = 60
"""Frames, at the most, on their way between two counts: the healths are read one by one."""
SERVICES = ("recorder", "tracker", "capture")


def soak(folder: Path, minutes: float) -> dict[str, Any]:
    """Run the rig and return what was seen, by service."""
    rig = RunningRig(folder)
    try:
        _prepare(rig, folder)
        rig.python("-c", "while True: pass")
        processes = {}
        for name in SERVICES:  # the camera last, so that nobody misses its first frames
            processes[name] = rig.inhand(name, "--config", rig.config)
            processes[name].said("is up")
        readings = _watch(processes, minutes, folder / "disk")
        return {
            "minutes": minutes,
            "services": {name: _growth(rows) for name, rows in readings.items()},
            "frames": _account(rig.healths()),
        }
    finally:
        rig.close()


def _prepare(rig: RunningRig, folder: Path) -> None:
    people, model = folder / "people", folder / "mug.model"
    arguments = ["--interactions", "drinkFromMug", "--participants", "3", "--frames", "300"]
    for verb in (
        ("simulate", people, *arguments),
        ("train", people, "-o", model, "--without", "p00"),
    ):
        made = rig.inhand(*verb)  # may compile first
        assert made.popen.wait(600.0) == 0, made.stderr
    recording = sorted((people / "recordings").glob("*.mcap"))[0]
    rig.configure(
        f'[capture.capture]\nsource = "replay"\noptions = {{ file = "{recording}", loop = true }}\n'
        f'[tracker.tracker]\ncamera = "capture"\nmodel = "{model}"\n'
        f'[recorder.recorder]\nfolder = "{folder}/disk"\nstreams = ["info", "skeletons", "rgbd", '
        '"pose"]\nsplit_bytes = "64 MiB"'
    )


@dataclass(frozen=True)
class Reading:
    """One look at a process: seconds since the begin, bytes resident, open files, and threads by
    name."""

    seconds: float
    resident: int
    files: int
    threads: Counter[str]


def _watch(processes: dict[str, Process], minutes: float, disk: Path) -> dict[str, list[Reading]]:
    readings: dict[str, list[Reading]] = {name: [] for name in processes}
    begin = time.monotonic()
    while (passed := time.monotonic() - begin) < 60.0 * minutes:
        for name, process in processes.items():
            seen = psutil.Process(process.pid)
            threads = Counter(psutil.Process(one.id).name() for one in seen.threads())
            readings[name].append(Reading(passed, seen.memory_info().rss, seen.num_fds(), threads))
        for old in sorted(disk.glob("*.mcap"))[:-2]:  # the disk of a soak is not the point
            old.unlink()
        time.sleep(PERIOD_S)
    return readings


def _growth(readings: list[Reading]) -> dict[str, Any]:
    settled = readings[len(readings) // 3 :]
    early, late = settled[:6], settled[-6:]
    seconds, resident = np.array([(one.seconds, one.resident) for one in settled]).T
    files = [int(np.median([one.files for one in some])) for some in (early, late)]
    # What threads were always there late, beyond those that were ever there early.
    lasting = reduce(and_, (one.threads for one in late))
    return {
        "mb_at_the_end": round(resident[-1] / 1e6, 1),
        "mb_per_hour": round(float(np.polyfit(seconds, resident, 1)[0]) * 3600.0 / 1e6, 2),
        "file_handles_gained": files[1] - files[0],
        "threads": sum(lasting.values()),
        "threads_gained": dict(lasting - reduce(or_, (one.threads for one in early))),
    }


def _account(healths: dict[str, Any]) -> dict[str, int]:
    def of(service: str, stream: str) -> dict[str, int]:
        topics: dict[str, dict[str, int]] = healths[service]["topics"]
        return next(value for key, value in topics.items() if f"/{stream}/" in key)

    skeletons, pictures = of("tracker", "skeletons"), of("tracker", "rgbd")
    return {
        "published": of("capture", "rgbd")["published"],
        "recorded": of("recorder", "rgbd")["received"],
        "lost_before_the_recorder": of("recorder", "rgbd")["lost"],
        "skeletons_published": of("capture", "skeletons")["published"],
        "skeletons_at_the_tracker": skeletons["received"],
        "skeletons_lost": max(
            of("capture", "skeletons")["published"] - skeletons["received"] - skeletons["dropped"],
            0,
        ),
        "skeletons_left_out": skeletons["dropped"],
        "poses": of("tracker", "pose")["published"],
        "pictures_at_the_tracker": pictures["received"],
        "pictures_lost": pictures["lost"],
        "pictures_left_out": pictures["dropped"],
    }


def judge(seen: dict[str, Any]) -> bool:
    """Whether nothing grew and all was used or counted, but for what was under way at the end."""
    frames = seen["frames"]
    unaccounted = (
        frames["published"] - frames["recorded"] - frames["lost_before_the_recorder"],
        frames["skeletons_published"]
        - frames["skeletons_lost"]
        - frames["skeletons_left_out"]
        - frames["poses"],
    )
    # What an inbox had no room for came and was left out, but never taken.
    never_taken = frames["published"] - frames["pictures_at_the_tracker"] - frames["pictures_lost"]
    return (
        max(map(abs, unaccounted)) <= MOST_UNDER_WAY
        and -MOST_UNDER_WAY <= never_taken <= frames["pictures_left_out"] + MOST_UNDER_WAY
        and all(
            service["mb_per_hour"] < MOST_GROWTH_MB_PER_HOUR
            and service["file_handles_gained"] <= 0
            and not service["threads_gained"]
            for service in seen["services"].values()
        )
    )


def main() -> int:
    """Run once and print what was seen."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=30.0)
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        seen = soak(Path(folder), chosen.minutes)
    print(json.dumps(seen, indent=2))
    return 0 if judge(seen) else 1


if __name__ == "__main__":
    sys.exit(main())
