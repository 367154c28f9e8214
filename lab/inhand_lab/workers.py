"""Runs work in several processes of one thread each, so that they never ask for more cores."""

import os
import signal
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing import get_context
from typing import TypeVar

import cv2
from inhand_runtime.errors import InhandError

from inhand_lab.cluster import current_cluster, on_cluster, run_on_cluster

Task = TypeVar("Task")
Result = TypeVar("Result")

ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"), "1"
)


def usable_cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0))


@contextmanager
def on_one_core() -> Iterator[None]:
    """Run a block on one of the cores that this process may use."""
    usable = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(usable)})
    try:
        yield
    finally:
        os.sched_setaffinity(0, usable)


@contextmanager
def working(cluster: str | None) -> Iterator[int]:
    """Let work go to the Dask cluster at an address while a block runs, or stay here; the number
    of tasks that are worked on at a time."""
    if cluster is None:
        yield usable_cores()
        return
    with on_cluster(cluster) as workers:
        yield workers


def in_processes(
    function: Callable[[Task], Result],
    tasks: Sequence[Task],
    processes: int,
    on_done: Callable[[Result], None] = lambda _: None,
    *,
    apart: bool = False,
) -> list[Result]:
    """Return the results of all tasks, in their order; ``on_done`` gets each as it comes.

    A single task, or a single process, runs in this one, unless all shall run ``apart``: in
    workers, whose single thread gives the same last bits however many there are. The first error
    ends all; raises InhandError when a worker is killed. Inside of ``working`` all run on its
    cluster, where the tasks of a killed worker are done by another one.
    """
    if (cluster := current_cluster()) is not None:
        return run_on_cluster(cluster, function, tasks, on_done)
    if not apart and (processes == 1 or len(tasks) == 1):
        results = []
        for task in tasks:
            results.append(function(task))
            on_done(results[-1])
        return results
    # Libraries size their pools of threads when they are loaded: a worker inherits the limits.
    with _environment(ONE_THREAD):
        pool = ProcessPoolExecutor(
            max(1, min(processes, len(tasks))), get_context("spawn"), initializer=_start_worker
        )
        with pool:
            futures = [pool.submit(function, task) for task in tasks]
            try:
                for future in as_completed(futures):
                    on_done(future.result())
            except BrokenProcessPool:
                raise InhandError(
                    "a worker process ended by itself, most often because memory ran out: free "
                    "some, or give this command one core (taskset -c 0)"
                ) from None
            except BaseException:
                pool.shutdown(cancel_futures=True)
                raise
    return [future.result() for future in futures]


def _start_worker() -> None:
    cv2.setNumThreads(1)
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@contextmanager
def _environment(values: Mapping[str, str]) -> Iterator[None]:
    before = {name: os.environ.get(name) for name in values}
    os.environ.update(values)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
