"""What two workers of a Dask cluster gain here: ``python tests/scenes/cluster_speed.py``.

Leaves one person out of eight (no images), each way several times in turn: by one process of this
machine and by two, by a cluster of one worker and of two, each of one thread. Says for each the
wall clock, the processor time of all its processes and of the one that took the most, and the load
before it; all tables must be the same. Where other programs take the processors, the wall clock
shows them: then the processor time of the busiest process is what a quiet machine would take.
"""

import argparse
import json
import os
import tempfile
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import psutil
from dask_cluster import dask_cluster
from inhand_lab.workers import ONE_THREAD, on_one_core
from running_rig import RunningRig

WAYS = ("here", 1), ("here", 2), ("cluster", 1), ("cluster", 2)
LOOK_S = 0.2
"""Seconds between two looks at the processor time of processes."""


def main() -> None:
    """Run it, and print what it showed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--interactions", nargs="+", default=["drinkFromMug", "sweepFloor"])
    parser.add_argument("--frames", type=int, default=300)
    parser.add_argument("--turns", type=int, default=2)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        dataset = Path(folder) / "people8"
        _simulate(Path(folder), dataset, arguments.interactions, arguments.frames)
        tables = []
        for turn in range(arguments.turns):
            for where, count in WAYS:
                run = Path(folder) / f"{turn}_{where}_{count}"
                run.mkdir()
                load = os.getloadavg()[0]
                with _processor_seconds() as spent:
                    seconds, table = _evaluated(run, dataset, where, count)
                tables.append(table)
                print(
                    f"{where}, {count} at a time: {seconds:.1f} s; of processors "
                    f"{sum(spent.values()):.1f} s, the busiest process {max(spent.values()):.1f} s;"
                    f" load before {load:.1f}",
                    flush=True,
                )
        assert all(table == tables[0] for table in tables), "the tables differ"
        print(f"{len(tables)} equal tables")


def _simulate(folder: Path, dataset: Path, interactions: Sequence[str], frames: int) -> None:
    rig = RunningRig(folder)
    what = ["--participants", "8", "--seed", "2", "--frames", str(frames), "--no-images"]
    process = rig.inhand("simulate", dataset, "--interactions", *interactions, *what)
    assert process.popen.wait() == 0, process.stderr
    rig.close()


def _evaluated(folder: Path, dataset: Path, where: str, count: int) -> tuple[float, Any]:
    """The seconds that an evaluation took, and its table."""
    result = folder / "result.json"
    command: list[str | Path] = ["evaluate", dataset, "--no-images", "--json", result]
    rig = RunningRig(folder)
    try:
        with ExitStack() as stack:
            if where == "cluster":
                cluster = stack.enter_context(dask_cluster(rig, count))
                command += ["--cluster", cluster.address]
            elif count == 1:
                stack.enter_context(on_one_core())
            began = time.monotonic()
            process = rig.python("-m", "inhand", *command, **ONE_THREAD)
            assert process.popen.wait() == 0, process.stderr
            seconds = time.monotonic() - began
    finally:
        rig.close()
    table = json.loads(result.read_text())
    del table["seconds"]
    return seconds, table


@contextmanager
def _processor_seconds() -> Iterator[dict[int, float]]:
    """The processor time of each process that this one starts in a block, by its number."""
    spent: dict[int, float] = {}
    ended = threading.Event()

    def watch() -> None:
        while not ended.wait(LOOK_S):
            for one in psutil.Process().children(recursive=True):
                try:
                    times = one.cpu_times()
                except psutil.NoSuchProcess:  # it has just ended
                    continue
                spent[one.pid] = max(times.user + times.system, spent.get(one.pid, 0.0))

    watcher = threading.Thread(target=watch)
    watcher.start()
    try:
        yield spent
    finally:
        ended.set()
        watcher.join()


if __name__ == "__main__":
    main()
