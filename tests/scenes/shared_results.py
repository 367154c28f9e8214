"""Results of slow functions, made once a run and shared by the tests of all its workers.

The functions give the same for the same arguments, so what is asked for again is read from a file
instead. The folder is the run's own: nothing is left from a run of other sources.
"""

import fcntl
import functools
import hashlib
import importlib
import os
import pickle
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import ParamSpec, TypeVar
from unittest import mock

import pytest

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")

SHARED = (
    ("inhand_lab.training.model_training", "find_viewpoints"),
    ("inhand_lab.training.model_training", "learn_prior"),
    ("inhand_lab.evaluation.fold_model", "find_viewpoints"),
    ("inhand_lab.evaluation.fold_model", "learn_prior"),
    ("inhand_lab.benchmarks.fusion_cost", "find_viewpoints"),
    ("inhand_lab.benchmarks.tracker_speed", "find_viewpoints"),
    ("inhand_lab.benchmarks.likelihood_check", "find_viewpoints"),
    ("inhand_lab.training.recogniser_training", "watch_idle"),
    ("inhand_lab.training.recogniser_training", "read_movement"),
)
"""Where the slow functions are called that many tests call with the same arguments. Their own tests
call them elsewhere."""

SHARING = "shares_results"
"""Name of the attribute that marks a function which keeps its results in the folder."""


def run_folder(factory: pytest.TempPathFactory) -> Path:
    """The folder that all workers of a run share."""
    own = factory.getbasetemp()
    return own.parent if "PYTEST_XDIST_WORKER" in os.environ else own


@contextmanager
def results_shared(folder: Path) -> Iterator[None]:
    """While this lasts, the functions of SHARED keep their results in a folder."""
    folder.mkdir(exist_ok=True)
    with pytest.MonkeyPatch.context() as patch:
        for module, name in SHARED:
            called = importlib.import_module(module)
            function = getattr(called, name)
            # A worker may run tests of two folders that share: wrapped twice, a function would wait
            # for the lock that it holds itself.
            if not hasattr(function, SHARING):
                patch.setattr(called, name, sharing(function, folder))
        yield


def sharing(function: Callable[Arguments, Result], folder: Path) -> Callable[Arguments, Result]:
    """The function, but each result is made by one worker while others wait for its file.

    Functions among its named arguments report progress: they are called as often as they were when
    the result was made.
    """

    @functools.wraps(function)
    def shared(*args: Arguments.args, **kwargs: Arguments.kwargs) -> Result:
        reports = {name: value for name, value in kwargs.items() if callable(value)}
        plain = {name: value for name, value in kwargs.items() if name not in reports}
        asked = pickle.dumps((function.__module__, function.__qualname__, args, plain))
        path = folder / hashlib.sha256(asked + repr(sorted(reports)).encode()).hexdigest()
        with path.with_suffix(".lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not path.exists():
                calls = {name: mock.Mock() for name in reports}
                made = function(*args, **plain, **calls)  # type: ignore[call-arg]
                counts = {name: call.call_count for name, call in calls.items()}
                path.write_bytes(pickle.dumps((made, counts)))
        result: Result
        result, counts = pickle.loads(path.read_bytes())
        for name, count in counts.items():
            for _ in range(count):
                reports[name]()
        return result

    setattr(shared, SHARING, True)
    return shared
