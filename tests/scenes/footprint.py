"""Says how soon each daemon of a rig is up, and how much memory and processor it takes.

``python tests/scenes/footprint.py``: a simulated camera, a tracker, outcomes and a recorder run as
processes. Each is started twice: the first start may compile, the second is what is measured.
Memory is what is resident after a while of work, and of that what the process has for itself
(``own_mb``): the rest are pages of libraries, which processes share. Processor time is that of the
while.
"""

import argparse
import json
import tempfile
import time
from pathlib import Path

import psutil
from running_rig import Process, RunningRig

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
        f'[outcomes.outcomes]\ndatabase = "{folder}/outcomes.db"\nalways_in_use = ["mug"]\n'
        f'[recorder.recorder]\nfolder = "{folder}/disk"'
    )


def _run(rig: RunningRig, seconds: float) -> dict[str, dict[str, float]]:
    processes: dict[str, Process] = {}
    up: dict[str, float] = {}
    for name in ("recorder", "outcomes", "tracker", "capture"):
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
            "own_mb": round(one.memory_full_info().uss / 1e6, 1),
            "threads": one.num_threads(),
            "cores": round((sum(one.cpu_times()[:2]) - before[name]) / seconds, 2),
        }
        for name, one in seen.items()
    }
    for process in processes.values():
        process.stop()
    return result


def main() -> None:
    """Measure once and print what was seen."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=30.0)
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        seen = measure(Path(folder), chosen.seconds)
    print(json.dumps(seen, indent=2))


if __name__ == "__main__":
    main()
