"""``inhand object new --mesh``: the right size, or a question, and never silently wrong."""

import os
import pty
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from inhand_tracker.shape.shape import load_shape
from mesh_files import FOUND, FoundMesh

from inhand.__main__ import main

LONG = pytest.mark.long
BOTTLE = FOUND[1]


def new(folder: Path, mesh: Path, *options: str) -> int:
    return main(["object", "new", "thing", "--dataset", str(folder), "--mesh", str(mesh), *options])


def check_size(folder: Path, found: FoundMesh) -> None:
    shape = load_shape(folder / "objects/thing")
    sides = np.ptp(shape.vertices, axis=0)
    np.testing.assert_allclose(sides, np.ptp(found.model.vertices, axis=0), atol=5e-4)
    upper = (found.model.vertices[:, 2] > found.model.vertices[:, 2].mean()).mean()
    assert (shape.vertices[:, 2] > shape.vertices[:, 2].mean()).mean() == pytest.approx(
        upper, abs=0.1
    )


@LONG
@pytest.mark.parametrize("found", FOUND, ids=lambda found: found.name)
def test_a_mesh_comes_out_at_its_true_size_or_asks_what_it_does_not_say(
    found: FoundMesh, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mesh = found.write(tmp_path)
    given: list[str] = []
    for option, value in found.options.items():
        assert new(tmp_path, mesh, *given) == 2
        (line,) = capsys.readouterr().err.splitlines()
        unsaid = {f"--{option}" for option in found.options} - set(given)
        assert all(option in line for option in unsaid)
        assert not (tmp_path / "objects").exists()
        given += [f"--{option}", value]
    assert new(tmp_path, mesh, *given) == 0
    check_size(tmp_path, found)


@LONG
def test_at_a_terminal_what_a_file_does_not_say_is_asked_until_it_is_answered(
    tmp_path: Path,
) -> None:
    mesh = BOTTLE.write(tmp_path)
    own, terminal = pty.openpty()
    command = ["object", "new", "thing", "--dataset", str(tmp_path), "--mesh", str(mesh)]
    asked = subprocess.Popen(
        [sys.executable, "-m", "inhand", *command],
        stdin=terminal,
        stdout=subprocess.PIPE,
        text=True,
    )
    os.write(own, b"furlong\ninch\nq\ny\n")
    told, _ = asked.communicate()
    os.close(own)
    os.close(terminal)
    assert asked.returncode == 0
    assert "in which unit is it?" in told
    assert "inch (21.5 cm long)" in told
    assert "which of them points up?" in told
    check_size(tmp_path, BOTTLE)


@pytest.mark.parametrize(
    ("options", "line"),
    [
        (["--unit", "mm", "--size", "4"], "--unit and --size both say how large it is"),
        (["--height", "9"], "--height is for --kind, and this is by --mesh"),
        (["--kind", "mug"], "--mesh and --kind both say what it is"),
        (["--unit", "m", "--up", "y"], "by --unit m it is 8.46 m long"),
    ],
)
def test_options_that_do_not_go_together_are_refused(
    options: list[str], line: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mesh = BOTTLE.write(tmp_path)
    assert new(tmp_path, mesh, *options) == 2
    (told,) = capsys.readouterr().err.splitlines()
    assert told.startswith(f"inhand object: {line}")
