"""A Dask cluster of worker processes on this machine, and tasks for it."""

import os
import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.workers import ONE_THREAD
from running_rig import Process, RunningRig, free_port

NO_DASHBOARD = ("--no-dashboard", "--host", "127.0.0.1")


@dataclass(frozen=True)
class DaskCluster:
    """The scheduler's address, and its workers."""

    address: str
    workers: tuple[Process, ...]


@contextmanager
def dask_cluster(
    rig: RunningRig, workers: int, *, threads: int = 1, deaths: int = 3
) -> Iterator[DaskCluster]:
    """Run a cluster while a block runs; its processes end with the rig. A task that outlives more
    than so many ``deaths`` of workers is given up."""
    port = str(free_port())
    address = f"tcp://127.0.0.1:{port}"
    scenes = {
        "PYTHONPATH": str(Path(__file__).parent),
        "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": str(deaths),
    }
    scheduler = rig.python(
        "-m", "distributed.cli.dask_scheduler", *NO_DASHBOARD, "--port", port, **scenes
    )
    scheduler.said("Scheduler at")
    found = tuple(
        rig.python(
            "-m", "distributed.cli.dask_worker", address, "--nthreads", str(threads), "--no-nanny",
            "--local-directory", rig.folder / "dask", *NO_DASHBOARD,
            **scenes, **ONE_THREAD,
        )
        for _ in range(workers)
    )  # fmt: skip
    for worker in found:
        worker.said("Registered to")
    yield DaskCluster(address, found)


def process_of(task: int) -> tuple[int, int]:
    """The task and the process that did it, in a tenth of a second."""
    time.sleep(0.1)
    return task, os.getpid()


def fail(task: int) -> int:
    """Fail at the third task."""
    if task == 2:
        raise DatasetError("broken: mend it")
    return task


def die(task: int) -> int:
    """End the worker."""
    os.kill(os.getpid(), signal.SIGKILL)
    return task


def die_once(task: tuple[Path, int]) -> int:
    """End the worker at the second task, but only the first worker."""
    mark, number = task
    time.sleep(0.05)
    if number == 1 and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return number
