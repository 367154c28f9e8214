"""A recording that tests damage copies of."""

from pathlib import Path

import pytest
from recordings import write_recording


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A whole recording at 30 Hz of three keys, in several chunks."""
    return write_recording(tmp_path_factory.mktemp("whole") / "walk.mcap")
