"""Which worker runs which tests, and in which order, where several share the run (pytest-xdist)."""

import os
from collections.abc import Sequence

import pytest
from xdist.scheduler.loadscope import LoadScopeScheduling

RIG = "rig"
"""Tests of a rig's real processes are one group: two rigs at once would starve each other."""

ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""Environment of workers: threads of one that wait for each other take the others' cores."""


def usable_cores() -> int:
    """Number of cores that this process may use."""
    return len(os.sched_getaffinity(0))


def ordered(items: Sequence[pytest.Item]) -> list[pytest.Item]:
    """Rigs first, then files with long tests, then the rest, which fills what gaps are left."""
    for item in items:
        if RIG in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.xdist_group(RIG))
    long_files = {item.path for item in items if item.get_closest_marker("long")}

    def turn(item: pytest.Item) -> int:
        if item.get_closest_marker("xdist_group"):
            return 0
        return 1 if item.path in long_files else 2

    return sorted(items, key=turn)


class FilesAndRigs(LoadScopeScheduling):
    """A file's tests stay on one worker, where they share what they made; so do all rigs'."""

    def _split_scope(self, nodeid: str) -> str:
        name, _, group = nodeid.rpartition("@")
        return group if name and group == RIG else nodeid.split("::")[0]
