"""The units as systemd itself reads and judges them, after they were installed."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest
from inhand_runtime.settings import SERVICES

from inhand.__main__ import main
from inhand.deployment import deploy_folder

MOST_EXPOSED = 20
"""What ``systemd-analyze security`` may say of a unit at most, in tenths."""
UNITS = sorted(path.name for path in (deploy_folder() / "systemd").glob("*.service"))
ANALYZE = shutil.which("systemd-analyze")

needs_systemd = pytest.mark.skipif(
    ANALYZE is None and "SYSTEMD_ANALYZE_REQUIRED" not in os.environ,
    reason="there is no systemd-analyze",
)


@pytest.fixture(scope="module")
def units(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of units of a system that Inhand was installed into."""
    root = tmp_path_factory.mktemp("system")
    assert main(["install", "--root", str(root)]) == 0
    return root / "etc/systemd/system"


def _analyze(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    command = ["systemd-analyze", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_each_daemon_has_a_unit() -> None:
    names = {unit.removeprefix("inhand-").removesuffix(".service").rstrip("@") for unit in UNITS}
    assert names >= {*SERVICES, "up"}


@needs_systemd
@pytest.mark.long
@pytest.mark.parametrize("unit", UNITS)
def test_systemd_finds_nothing_wrong_with_a_unit(units: Path, unit: str) -> None:
    done = _analyze("verify", "--man=no", units / unit)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


@needs_systemd
@pytest.mark.long
@pytest.mark.parametrize("unit", UNITS)
def test_a_unit_is_as_secluded_as_promised(units: Path, unit: str) -> None:
    done = _analyze(
        "security", "--offline=true", f"--threshold={MOST_EXPOSED}", "--no-pager", units / unit
    )
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize("unit", [one for one in UNITS if one != "inhand-hub.service"])
def test_a_unit_is_given_the_key_and_the_password_of_a_member(units: Path, unit: str) -> None:
    name = "%i" if unit.endswith("@.service") else "rig"
    lines = (units / unit).read_text().splitlines()
    for given in ("key.pem", "password"):
        assert f"LoadCredential={given}:inhand.{name}.{given}" in lines


@pytest.mark.parametrize("unit", UNITS)
def test_a_unit_runs_the_installed_program_and_is_watched(units: Path, unit: str) -> None:
    text = (units / unit).read_text()
    (start,) = [line for line in text.splitlines() if line.startswith("ExecStart=")]
    assert os.access(start.removeprefix("ExecStart=").split()[0], os.X_OK)
    shared = (units / "inhand-.service.d/10-inhand.conf").read_text()
    assert "\nType=notify\n" in shared.replace("[Service]", "\n")
    assert "\nWatchdogSec=" in shared
