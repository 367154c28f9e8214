"""What the doctor finds, and what it says of it."""

import json
import socket
from pathlib import Path

import pytest
from inhand_runtime.settings import ZenohSettings
from running_rig import RunningRig

from inhand.camera_findings import rule_finding, usb_cameras, usb_findings
from inhand.findings import (
    STA_UNSYNC,
    Finding,
    clock_finding,
    disk_finding,
    hub_findings,
    memory_finding,
    version_finding,
)


def _is_wrong(finding: Finding, words: str) -> bool:
    return finding.mend is not None and words in finding.what


def test_memory_is_enough_for_what_the_settings_name_or_must_be_mended() -> None:
    rig = {"capture": 1, "tracker": 1, "recorder": 1}
    assert memory_finding(rig, 8_000_000_000).mend is None
    assert _is_wrong(memory_finding(rig, 400_000_000), "takes about 610 MB")
    assert memory_finding({"capture": 0}).mend is None


def test_a_clock_that_nothing_keeps_right_must_be_mended() -> None:
    assert clock_finding(shared=True, status=0, year=2026).mend is None
    unkept = clock_finding(shared=True, status=STA_UNSYNC, year=2026)
    assert _is_wrong(unkept, "nothing keeps it right")
    assert clock_finding(shared=False, status=STA_UNSYNC, year=2026).mend is None
    assert _is_wrong(clock_finding(shared=False, status=0, year=1970), "never been set")


def test_the_clock_of_this_host_can_be_asked() -> None:
    assert clock_finding(shared=True).what.startswith("clock: ")


def test_a_full_disk_must_be_mended(tmp_path: Path) -> None:
    assert disk_finding(tmp_path, 50_000_000_000).mend is None
    assert _is_wrong(disk_finding(tmp_path, 1_000_000_000), "1.0 GB are free")
    assert str(tmp_path / "not/there") in disk_finding(tmp_path / "not/there").what


def test_a_hub_that_does_not_listen_must_be_mended() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
        (reached,) = hub_findings(ZenohSettings(connect=(f"tcp/127.0.0.1:{port}",)))
    (missed,) = hub_findings(ZenohSettings(connect=(f"tcp/127.0.0.1:{port}",)))
    assert reached.mend is None
    assert _is_wrong(missed, "cannot be reached")


def test_versions_are_told() -> None:
    assert "inhand " in version_finding().what
    assert "Python 3." in version_finding().what


def _usb(folder: Path, product: str, speed: str) -> tuple[Path, Path]:
    """A system's list of USB devices with one camera and something else, and the device files."""
    devices, files = folder / "devices", folder / "files"
    for name, vendor in (("1-1.2", "03e7"), ("1-1.3", "046d")):
        device = devices / name
        device.mkdir(parents=True)
        for file, text in (
            ("idVendor", vendor),
            ("idProduct", product),
            ("speed", speed),
            ("busnum", "1"),
            ("devnum", "12"),
        ):
            (device / file).write_text(text + "\n")
    (files / "001").mkdir(parents=True)
    (files / "001" / "012").touch()
    return devices, files


@pytest.mark.parametrize(
    ("product", "speed", "words", "wrong"),
    [
        ("2485", "480", "this user may open it", False),
        ("f63b", "5000", "this user may open it", False),
        ("f63b", "480", "480 Mbit/s, which is USB 2", True),
    ],
)
def test_a_camera_at_usb_is_found_with_its_speed(
    tmp_path: Path, product: str, speed: str, words: str, wrong: bool
) -> None:
    (finding,) = usb_findings(usb_cameras(*_usb(tmp_path, product, speed)))
    assert words in finding.what
    assert "USB port 1-1.2" in finding.what
    assert (finding.mend is not None) == wrong


def test_a_camera_that_may_not_be_opened_must_be_mended(tmp_path: Path) -> None:
    devices, files = _usb(tmp_path, "2485", "480")
    (files / "001" / "012").unlink()
    (finding,) = usb_findings(usb_cameras(devices, files))
    assert _is_wrong(finding, "this user may not open it")
    assert "03e7" in (finding.mend or "")


def test_a_udev_rule_for_cameras_is_found(tmp_path: Path) -> None:
    (tmp_path / "80-movidius.rules").write_text('ATTRS{idVendor}=="03e7", MODE="0666"')
    assert "80-movidius.rules lets users open cameras" in rule_finding((tmp_path,)).what
    assert "80-movidius" not in rule_finding((tmp_path / "none",)).what


@pytest.mark.long
def test_a_rig_that_can_start_passes_and_one_that_cannot_is_told_why(rig: RunningRig) -> None:
    found = rig.folder / "found.json"
    rig.configure('[recorder.disk]\nfolder = "recordings"\n')
    sound = rig.done("doctor", "--config", rig.config, "--json", found)
    findings = {one["what"]: one["mend"] for one in json.loads(found.read_text())["findings"]}
    assert findings["recorder disk: its settings are valid, and it can start"] is None
    assert any(what.startswith("disk: ") for what in findings)
    assert sound.popen.returncode == any(findings.values())

    rig.configure('[capture.front]\nsource = "oak"\n[capture.front.options]\nserial = 5\n')
    done = rig.done("doctor", "--config", rig.config)
    assert done.popen.returncode == 1
    assert "WRONG  capture front cannot start: " in done.stdout

    rig.configure('[capture.front]\nsource = "oak"\n')
    done = rig.done("doctor", "--config", rig.config)
    assert done.popen.returncode == 1
    wrong = "WRONG  camera of [capture.front] cannot be opened: no OAK camera is attached"
    assert wrong in done.stdout
