"""A rig of processes for these tests."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from running_rig import RunningRig


@pytest.fixture
def rig(tmp_path: Path) -> Iterator[RunningRig]:
    """Nothing runs yet; everything ends with the test."""
    running = RunningRig(tmp_path)
    yield running
    running.close()
