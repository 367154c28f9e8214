"""What all tests share."""

import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings
from running_rig import RunningRig
from scheduling import ONE_THREAD, WaitingApart, ordered, usable_cores
from wire import Wire
from xdist.remote import Producer

# Example times on a busy machine say nothing about the code; each test has its own timeout.
settings.register_profile("inhand", deadline=None)
settings.load_profile("inhand")


def pytest_configure(config: pytest.Config) -> None:
    if config.getoption("numprocesses", None):
        os.environ.update(ONE_THREAD)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers() -> int:
    return usable_cores() + 1


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Producer) -> WaitingApart | None:
    apart = (config.option.numprocesses or 0) > usable_cores()
    return WaitingApart(config, log) if apart and config.option.dist == "loadfile" else None


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    if hasattr(config, "workerinput"):
        items[:] = ordered(items)


@pytest.fixture
def rig(tmp_path: Path) -> Iterator[RunningRig]:
    """Nothing runs yet; everything ends with the test."""
    running = RunningRig(tmp_path)
    yield running
    running.close()


@pytest.fixture
def wire(rig: RunningRig) -> Iterator[Wire]:
    """The test's own session at the rig's meeting address."""
    with Wire.at(rig.meeting) as opened:
        yield opened
