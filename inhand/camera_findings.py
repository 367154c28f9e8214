"""What `inhand doctor` finds of cameras: at USB by the system's own list, and through depthai."""

import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from inhand_runtime.source import SourceAbsentError, SourceError
from pydantic import ValidationError

from inhand.findings import Finding

VENDOR = "03e7"
"""Number of the maker of the chips of OAK cameras, by USB."""
BOOTED = "f63b"
"""Number of a camera on which something runs; before, all of them are slow."""
USB3_MBITS = 5000
RULE_FOLDERS = (Path("/etc/udev/rules.d"), Path("/lib/udev/rules.d"), Path("/usr/lib/udev/rules.d"))
SYSTEM_DEVICES, DEVICE_FILES = Path("/sys/bus/usb/devices"), Path("/dev/bus/usb")


@dataclass(frozen=True)
class UsbCamera:
    """A camera as the system lists it."""

    port: str
    product: str
    mbits: float
    file: Path


def usb_cameras(
    devices: Path = SYSTEM_DEVICES, files: Path = DEVICE_FILES
) -> tuple[UsbCamera, ...]:
    """The OAK cameras at USB, without any library."""
    found = []
    for vendor in sorted(devices.glob("*/idVendor")):
        try:
            if vendor.read_text().strip() == VENDOR:
                found.append(_usb_camera(vendor.parent, files))
        except FileNotFoundError:
            continue  # it was unplugged meanwhile
    return tuple(found)


def _usb_camera(device: Path, files: Path) -> UsbCamera:
    product, mbits, bus, number = (
        (device / name).read_text().strip() for name in ("idProduct", "speed", "busnum", "devnum")
    )
    file = files / f"{int(bus):03}" / f"{int(number):03}"
    return UsbCamera(device.name, product, float(mbits), file)


def usb_findings(cameras: tuple[UsbCamera, ...]) -> Iterator[Finding]:
    """Permission and speed of each camera at USB."""
    if not cameras:
        yield Finding("cameras: none is attached by USB")
    for camera in cameras:
        what = f"camera at USB port {camera.port}"
        if not os.access(camera.file, os.R_OK | os.W_OK):
            yield Finding(f"{what}: this user may not open it", _udev_mend())
        elif camera.product == BOOTED and camera.mbits < USB3_MBITS:
            yield Finding(
                f"{what}: it runs at {camera.mbits:g} Mbit/s, which is USB 2",
                "use a USB 3 cable and port; 1280x720 needs them",
            )
        else:
            yield Finding(f"{what}: this user may open it")


def rule_finding(folders: tuple[Path, ...] = RULE_FOLDERS) -> Finding:
    """Whether a udev rule lets users open cameras at all."""
    for folder in folders:
        for rules in sorted(folder.glob("*.rules")):
            if VENDOR in _readable(rules):
                return Finding(f"udev: {rules} lets users open cameras")
    if os.geteuid() == 0:
        return Finding("udev: no rule for cameras; this user needs none, others do")
    return Finding("udev: no rule lets users open cameras at USB", _udev_mend())


def _readable(rules: Path) -> str:
    """A file's text; none of one that this user may not read, as some programs leave theirs."""
    try:
        return rules.read_text(errors="replace")
    except PermissionError:
        return ""


def oak_findings(tables: Mapping[str, Mapping[str, object]]) -> Iterator[Finding]:
    """Whether the camera of each table of capture is there; ``tables`` are their options."""
    from inhand_capture.sources.oak.devices import IN_USE, attached_cameras, choose
    from inhand_capture.sources.oak.options import OakOptions

    cameras = attached_cameras()
    for name, options in tables.items():
        what = f"camera of [capture.{name}]"
        try:
            chosen = choose(cameras, OakOptions.model_validate(options))
        except ValidationError:
            continue  # the line that it cannot start says what is wrong with them
        except SourceAbsentError as error:
            if IN_USE in str(error):
                yield Finding(f"{what}: it is in use, by this rig if it runs")
            else:
                yield Finding(f"{what} cannot be opened", str(error))
        except SourceError as error:
            yield Finding(f"{what} cannot be opened", str(error))
        else:
            yield Finding(f"{what}: {chosen.getDeviceId() or chosen.name} is there")


def _udev_mend() -> str:
    return (
        f'write SUBSYSTEM=="usb", ATTRS{{idVendor}}=="{VENDOR}", MODE="0666" into '
        "/etc/udev/rules.d/80-movidius.rules, run `udevadm control --reload-rules && udevadm "
        "trigger`, and plug the camera in again"
    )
