"""Says how soon each daemon of a rig is up, and how much memory and processor it takes.

``python tests/scenes/footprint.py``: a simulated camera, a tracker and a recorder run as processes.
Each is started twice: the first start may compile, the second is what is measured. Memory is what
is resident after a while of work; processor time is that of the while. Exit code 1 where a bound of
docs/reliability.md is broken.
"""

import argparse
import json
import sys
import tempfile
import time
from pathlib import Path

import psutil
from running_rig import Process, RunningRig

MOST_MB = {"tracker": 180.0, "capture": 250.0, "recorder": 70.0}
MOST_SECONDS_UNTIL_UP = 3.0
SETTLES_S = 5.0
"""Seconds for which a rig works before its processor time is counted."""


def measure(folder: Path, seconds: float) -> dict[str, dict[str, float]]:
    """Run the rig twice, and return what was seen of each service in the second run."""
    rig = RunningRig(folder)
    try:
        _prepare(rig, folder)
        _run(rig, SETTLES_S)
        return _run(rig, seconds)
    finally:
        rig.close()


def _prepare(rig: RunningRig, folder: Path) -> None:
    people, model = folder / "people", folder / "mug.model"
    arguments = ["--interactions", "drinkFromMug", "--participants", "3", "--frames", "300"]
    rig.done("simulate", people, *arguments)
    rig.done("train", people, "-o", model)
    rig.configure(
        '[capture.capture]\nsource = "simulator"\noptions = { participant = 5 }\n'
        f'[tracker.tracker]\ncamera = "capture"\nmodel = "{model}"\n'
        f'[recorder.recorder]\nfolder = "{folder}/disk"'
    )


def _run(rig: RunningRig, seconds: float) -> dict[str, dict[str, float]]:
    processes: dict[str, Process] = {}
    up: dict[str, float] = {}
    for name in ("recorder", "tracker", "capture"):
        began = time.monotonic()
        processes[name] = rig.inhand(name, "--config", rig.config)
        processes[name].said("is up")
        up[name] = time.monotonic() - began
    time.sleep(SETTLES_S)
    seen = {name: psutil.Process(process.pid) for name, process in processes.items()}
    before = {name: sum(one.cpu_times()[:2]) for name, one in seen.items()}
    time.sleep(seconds)
    result = {
        name: {
            "seconds_until_up": round(up[name], 2),
            "resident_mb": round(one.memory_info().rss / 1e6, 1),
            "threads": one.num_threads(),
            "cores": round((sum(one.cpu_times()[:2]) - before[name]) / seconds, 2),
        }
        for name, one in seen.items()
    }
    for process in processes.values():
        process.stop()
    return result


def judge(seen: dict[str, dict[str, float]]) -> bool:
    """Whether each service is up in time and keeps within its memory."""
    return all(
        one["resident_mb"] <= MOST_MB[name] and one["seconds_until_up"] <= MOST_SECONDS_UNTIL_UP
        for name, one in seen.items()
    )


def main() -> int:
    """Measure once and print what was seen."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=30.0)
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        seen = measure(Path(folder), chosen.seconds)
    print(json.dumps(seen, indent=2))
    return 0 if judge(seen) else 1


if __name__ == "__main__":
    sys.exit(main())
