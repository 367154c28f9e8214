"""Work in several processes."""

import os
import signal
import time

import cv2
import pytest
from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.workers import in_processes, usable_cores
from inhand_runtime.errors import InhandError


def describe(task: int) -> tuple[int, int, str | None, int]:
    return task, os.getpid(), os.environ.get("OPENBLAS_NUM_THREADS"), cv2.getNumThreads()


def fail(task: int) -> int:
    if task == 1:
        raise DatasetError("broken: mend it")
    time.sleep(0.01)
    return task


def die(task: int) -> int:
    os.kill(os.getpid(), signal.SIGKILL)
    return task


def test_results_come_in_the_order_of_the_tasks_from_workers_of_one_thread(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "2")
    before = dict(os.environ)
    done: list[int] = []
    results = in_processes(describe, range(6), 2, lambda result: done.append(result[0]))
    assert [task for task, *_ in results] == list(range(6))
    assert sorted(done) == list(range(6))
    assert os.getpid() not in {process for _, process, _, _ in results}
    assert {(blas, opencv) for _, _, blas, opencv in results} == {("1", 1)}
    assert dict(os.environ) == before


@pytest.mark.parametrize(("tasks", "processes"), [(range(3), 1), (range(1), 2)])
def test_a_single_task_or_process_stays_here(tasks: range, processes: int) -> None:
    assert {process for _, process, _, _ in in_processes(describe, tasks, processes)} == {
        os.getpid()
    }


def test_the_first_error_reaches_the_caller_as_it_is() -> None:
    with pytest.raises(DatasetError, match="broken: mend it"):
        in_processes(fail, range(20), 2)


def test_a_worker_that_is_killed_is_told_with_the_mend() -> None:
    with pytest.raises(InhandError, match="memory ran out"):
        in_processes(die, range(2), 2)


def test_there_are_cores() -> None:
    assert 1 <= usable_cores() <= (os.cpu_count() or 1)
