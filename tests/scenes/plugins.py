"""The sources of the tests as an installed plugin."""

import shutil
from pathlib import Path

SCENES = Path(__file__).parent
SOURCES = {
    "scripted": "scripted_source:ScriptedSource",
    "stub_oak": "stub_oak_source:StubOakSource",
    "secret": "secret_source:SecretSource",
    "hanging": "hanging_source:HangingSource",
    "drawn": "drawn_camera:DrawnCamera",
    "unusable": "package_that_nobody_has:Source",
}
FILES = (
    "scripted_source.py",
    "stub_oak_source.py",
    "stub_oak.py",
    "secret_source.py",
    "hanging_source.py",
    "drawn_camera.py",
)


def install_plugins(folder: Path) -> Path:
    """Install them in a folder, which is for PYTHONPATH."""
    metadata = folder / "scripted-1.0.dist-info"
    metadata.mkdir(parents=True)
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: scripted\nVersion: 1.0\n")
    lines = [f"{name} = {place}\n" for name, place in SOURCES.items()]
    (metadata / "entry_points.txt").write_text("[inhand.sources]\n" + "".join(lines))
    for file in FILES:
        shutil.copy(SCENES / file, folder)
    return folder
