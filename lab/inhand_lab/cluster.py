"""Runs work on a Dask cluster in place of processes of this machine.

A worker that is killed costs the time of what it was doing: the scheduler gives that to another
one. Tasks name files, so every worker sees the same folders under the same paths.
"""

import importlib.metadata
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING, Any, TypeVar

import cv2
from inhand_runtime.errors import InhandError, SettingsError

if TYPE_CHECKING:
    from dask.distributed import Client

Task = TypeVar("Task")
Result = TypeVar("Result")

CONNECT_S = 10
"""Seconds in which a scheduler, and a first worker of it, must answer."""

_client: ContextVar["Client | None"] = ContextVar("cluster", default=None)


@contextmanager
def on_cluster(address: str) -> Iterator[int]:
    """Let ``workers.in_processes`` use a cluster while a block runs; the number of its workers.

    Raises SettingsError where none answers at the address, or its workers cannot do our work.
    """
    from dask.distributed import Client

    try:
        client = Client(address, timeout=CONNECT_S, set_as_default=False)  # type: ignore[no-untyped-call]
    except (OSError, ValueError) as error:
        raise SettingsError(
            f"no Dask scheduler answers at {address} ({error}): start one with `dask scheduler`"
        ) from None
    with client:
        workers = _checked_workers(client, address)
        token = _client.set(client)
        try:
            yield workers
        finally:
            _client.reset(token)


def current_cluster() -> "Client | None":
    """Return the cluster that work goes to now; None where it stays on this machine."""
    return _client.get()


def run_on_cluster(
    client: "Client",
    function: Callable[[Task], Result],
    tasks: Sequence[Task],
    on_done: Callable[[Result], None],
) -> list[Result]:
    """Return the results of all tasks, in their order; ``on_done`` gets each as it comes.

    The first error ends all. Raises InhandError where several workers died of one task.
    """
    # Not by joblib, whose Dask backend (1.6.0) waits for ever for a task that no worker survives.
    from distributed import KilledWorker, as_completed

    futures = [client.submit(_in_one_thread, function, task, pure=False) for task in tasks]
    numbers = {future: number for number, future in enumerate(futures)}
    results: dict[int, Result] = {}
    try:
        done = as_completed(futures, loop=client.loop, with_results=True)  # type: ignore[no-untyped-call]
        for future, result in done:
            results[numbers[future]] = result
            on_done(result)
    except KilledWorker as error:
        raise InhandError(
            "workers ended again and again at one task, most often because memory ran out: free "
            f"some, or start fewer of them on a machine ({error})"
        ) from None
    finally:
        client.cancel(futures)  # type: ignore[no-untyped-call]
    return [results[number] for number in range(len(tasks))]


def _in_one_thread(function: Callable[[Task], Result], task: Task) -> Result:
    """Do one task in a worker."""
    cv2.setNumThreads(1)
    return function(task)


def _checked_workers(client: "Client", address: str) -> int:
    """Return the number of workers; raises SettingsError where they cannot do our work."""
    try:
        client.wait_for_workers(1, timeout=CONNECT_S)
    except TimeoutError:
        raise SettingsError(
            f"the Dask scheduler at {address} has no worker: start some with "
            f"`dask worker {address} --nthreads 1`"
        ) from None
    threads: dict[str, int] = client.nthreads()  # type: ignore[no-untyped-call]
    if several := [worker for worker, count in threads.items() if count > 1]:
        raise SettingsError(
            f"worker {several[0]} works on {threads[several[0]]} tasks at once, and ours need a "
            "process each: start it with `dask worker --nthreads 1 --nworkers N`"
        )
    ours = _release()
    releases: dict[str, Any] = client.run(_release, on_error="return")
    # The scheduler takes tasks apart, too.
    releases[address] = _release_of_scheduler(client)
    for where, release in releases.items():
        if release != ours:
            raise SettingsError(
                f"at {where} is Inhand {release}, and here {ours}: install the same release there"
            )
    return len(threads)


def _release_of_scheduler(client: "Client") -> str:
    try:
        return str(client.run_on_scheduler(_release))  # type: ignore[no-untyped-call]
    except ImportError:
        return "not installed"


def _release() -> str:
    return importlib.metadata.version("inhand")
