"""In which order tests run, where several workers share them (pytest-xdist).

Workers take whole files (``--dist loadfile``), as a file's tests share what they made, and take
them in the order of ``ordered``. So there are as many rigs at once as workers. One worker more than
there are cores takes those that mostly wait (``WAITING``). Marks of a group
(``xdist_group``) would not keep them apart: xdist 3.8 writes the group behind a test's id, which
pytest 9.2 does not show.
"""

import os
from collections.abc import Sequence

import pytest
from xdist.scheduler import LoadFileScheduling
from xdist.workermanage import WorkerController

ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""Environment of workers: threads of one that wait for each other take the others' cores."""

WAITING = (
    "tests/hub/",
    "tests/runtime/",
    "tests/recorder/",
    "tests/outcomes/test_service.py",
    "tests/outcomes/homeassistant/",
    "tests/inhand/test_backup.py",
    "tests/inhand/test_metrics.py",
    "tests/studio/test_camera_view.py",
)
"""Where tests wait for what others do or no longer do: they use a fifth of a core."""


def usable_cores() -> int:
    """Number of cores that this process may use."""
    return len(os.sched_getaffinity(0))


class WaitingApart(LoadFileScheduling):
    """Gives the files that mostly wait to the last worker, and no others to it; who has no others
    left helps it."""

    def _assign_work_unit(self, node: WorkerController) -> None:
        files = [scope for scope in self.workqueue if scope.startswith(WAITING)]
        if node.gateway.id != f"gw{self.config.option.numprocesses - 1}":
            files = [scope for scope in self.workqueue if scope not in files] or files
        if not files:
            node.shutdown()
            return
        self.workqueue.move_to_end(files[0], last=False)
        super()._assign_work_unit(node)


def ordered(items: Sequence[pytest.Item]) -> list[pytest.Item]:
    """Files with long tests first, those with rigs before all; the rest fills what gaps are left,
    so that no worker is idle while the last long test runs."""
    long = {item.path for item in items if item.get_closest_marker("long")}
    rigs = {item.path for item in items if "rig" in getattr(item, "fixturenames", ())}
    return sorted(items, key=lambda item: (item.path not in long, item.path not in rigs))
