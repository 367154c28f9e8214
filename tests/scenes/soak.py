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
from pathlib import Path
from typing import Any

import numpy as np
import psutil
from running_rig import Process, RunningRig

PERIOD_S = 5.0
MOST_GROWTH_MB_PER_HOUR = 5.0
SERVICES = ("recorder", "tracker", "capture")


def soak(folder: Path, minutes: float) -> dict[str, Any]:
    """Run the rig and return what was seen, by service."""
    rig = RunningRig(folder)
    try:
        _prepare(rig, folder)
        rig.python("-c", "while True: pass")
        processes = {name: rig.inhand(name, "--config", rig.config) for name in SERVICES}
        for process in processes.values():
            process.said("is up")
        readings = _watch(processes, minutes, folder / "disk")
        healths = {name: rig.health(name) for name in SERVICES}
        return {
            "minutes": minutes,
            "services": {name: _growth(np.array(rows)) for name, rows in readings.items()},
            "frames": _account(healths),
        }
    finally:
        rig.close()


def _prepare(rig: RunningRig, folder: Path) -> None:
    people, model = folder / "people", folder / "mug.model"
    arguments = ["--interactions", "drinkFromMug", "--participants", "3", "--frames", "300"]
    for made in (
        rig.done("simulate", people, *arguments),
        rig.done("train", people, "-o", model, "--without", "p00"),
    ):
        assert made.popen.returncode == 0, made.stderr
    recording = sorted((people / "recordings").glob("*.mcap"))[0]
    rig.configure(
        f'[capture.capture]\nsource = "replay"\noptions = {{ file = "{recording}", loop = true }}\n'
        f'[tracker.tracker]\ncamera = "capture"\nmodel = "{model}"\n'
        f'[recorder.recorder]\nfolder = "{folder}/disk"\nstreams = ["info", "skeletons", "rgbd", '
        '"pose"]\nsplit_bytes = "64 MiB"'
    )


def _watch(
    processes: dict[str, Process], minutes: float, disk: Path
) -> dict[str, list[list[float]]]:
    readings: dict[str, list[list[float]]] = {name: [] for name in processes}
    begin = time.monotonic()
    while (passed := time.monotonic() - begin) < 60.0 * minutes:
        for name, process in processes.items():
            seen = psutil.Process(process.pid)
            readings[name].append(
                [passed, seen.memory_info().rss, seen.num_fds(), seen.num_threads()]
            )
        for old in sorted(disk.glob("*.mcap"))[:-2]:  # the disk of a soak is not the point
            old.unlink()
        time.sleep(PERIOD_S)
    return readings


def _growth(rows: np.ndarray) -> dict[str, float]:
    settled = rows[len(rows) // 3 :]
    slope = np.polyfit(settled[:, 0], settled[:, 1], 1)[0] * 3600.0 / 1e6
    return {
        "mb_at_the_end": round(rows[-1, 1] / 1e6, 1),
        "mb_per_hour": round(float(slope), 2),
        "file_handles_gained": int(np.median(settled[-6:, 2]) - np.median(settled[:6, 2])),
        "threads_gained": int(np.median(settled[-6:, 3]) - np.median(settled[:6, 3])),
    }


def _account(healths: dict[str, Any]) -> dict[str, int]:
    def of(service: str, stream: str) -> dict[str, int]:
        topics: dict[str, dict[str, int]] = healths[service]["topics"]
        return next(value for key, value in topics.items() if f"/{stream}/" in key)

    skeletons, pictures = of("tracker", "skeletons"), of("tracker", "rgbd")
    return {
        "published": of("capture", "rgbd")["published"],
        "recorded": of("recorder", "rgbd")["received"],
        "lost_on_the_way": of("recorder", "rgbd")["lost"] + pictures["lost"] + skeletons["lost"],
        "skeletons_published": of("capture", "skeletons")["published"],
        "poses": of("tracker", "pose")["published"],
        "skeletons_left_out": skeletons["dropped"],
        "pictures_at_the_tracker": pictures["received"],
        "pictures_left_out": pictures["dropped"],
    }


def judge(seen: dict[str, Any]) -> bool:
    """Whether nothing grew and every skeleton was used or counted, but for those under way."""
    frames = seen["frames"]
    unaccounted = frames["skeletons_published"] - frames["poses"] - frames["skeletons_left_out"]
    return abs(unaccounted) <= 60 and all(
        service["mb_per_hour"] < MOST_GROWTH_MB_PER_HOUR
        and service["file_handles_gained"] <= 0
        and service["threads_gained"] <= 0
        for service in seen["services"].values()
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
