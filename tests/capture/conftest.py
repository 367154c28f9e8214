"""The scripted source as an installed plugin."""

import shutil
from pathlib import Path

import pytest

SCENES = Path(__file__).parents[1] / "scenes"
PLUGINS = (
    "scripted_source.py",
    "stub_oak_source.py",
    "stub_oak.py",
    "secret_source.py",
    "hanging_source.py",
)


@pytest.fixture
def own_data(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder for data of this test's own, its processes' too."""
    folder = tmp_path / "data"
    monkeypatch.setenv("INHAND_DATA", str(folder))
    return folder


@pytest.fixture
def plugin_folder(tmp_path: Path) -> Path:
    """A folder for PYTHONPATH in which the sources of the tests are installed."""
    folder = tmp_path / "plugins"
    metadata = folder / "scripted-1.0.dist-info"
    metadata.mkdir(parents=True)
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: scripted\nVersion: 1.0\n")
    (metadata / "entry_points.txt").write_text(
        "[inhand.sources]\nscripted = scripted_source:ScriptedSource\n"
        "stub_oak = stub_oak_source:StubOakSource\n"
        "secret = secret_source:SecretSource\n"
        "hanging = hanging_source:HangingSource\n"
        "unusable = package_that_nobody_has:Source\n"
    )
    for plugin in PLUGINS:
        shutil.copy(SCENES / plugin, folder)
    return folder
