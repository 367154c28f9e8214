"""In which order tests run, where several workers share them (pytest-xdist).

Workers take whole files (``--dist loadfile``), as a file's tests share what they made, and take
them in the order of ``ordered``. So there are as many rigs at once as workers. Marks of a group
(``xdist_group``) would not keep them apart: xdist 3.8 writes the group behind a test's id, which
pytest 9.2 does not show.
"""

import os
from collections.abc import Sequence

import pytest

ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""Environment of workers: threads of one that wait for each other take the others' cores."""


def usable_cores() -> int:
    """Number of cores that this process may use."""
    return len(os.sched_getaffinity(0))


def ordered(items: Sequence[pytest.Item]) -> list[pytest.Item]:
    """Files with long tests first, those with rigs before all; the rest fills what gaps are left,
    so that no worker is idle while the last long test runs."""
    long = {item.path for item in items if item.get_closest_marker("long")}
    rigs = {item.path for item in items if "rig" in getattr(item, "fixturenames", ())}
    return sorted(items, key=lambda item: (item.path not in long, item.path not in rigs))
