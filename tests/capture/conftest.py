"""The sources of the tests as an installed plugin."""

from pathlib import Path

import pytest
from plugins import install_plugins


@pytest.fixture
def own_data(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder for data of this test's own, its processes' too."""
    folder = tmp_path / "data"
    monkeypatch.setenv("INHAND_DATA", str(folder))
    return folder


@pytest.fixture
def plugin_folder(tmp_path: Path) -> Path:
    """A folder for PYTHONPATH in which the sources of the tests are installed."""
    return install_plugins(tmp_path / "plugins")
