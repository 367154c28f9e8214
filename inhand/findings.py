"""What `inhand doctor` finds of a host: memory, clock, disk, hubs and versions."""

import ctypes
import importlib.metadata
import os
import platform
import socket
import sys
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import psutil
from inhand_runtime.settings import ZenohSettings

MEMORY_OF = {
    "capture": 300e6,
    "tracker": 250e6,
    "recorder": 60e6,
    "studio": 300e6,
    "outcomes": 120e6,
    "hub": 60e6,
}
"""Bytes that an instance of each service takes (docs/reliability.md, "What a rig takes")."""
LEAST_DISK_BYTES = 20e9
"""Free bytes of a disk that a recorder fills within an hour (docs/tutorial.md)."""
LEAST_YEAR = 2025
"""The year before which a clock has never been set."""
CONNECT_S = 2.0
PACKAGES = ("inhand", "eclipse-zenoh", "numpy", "depthai", "ai-edge-litert")

STA_UNSYNC = 0x40


@dataclass(frozen=True)
class Finding:
    """One thing that was looked at: what it is, and its mend where it must be mended."""

    what: str
    mend: str | None = None


def memory_finding(instances: Mapping[str, int], available: int | None = None) -> Finding:
    """Whether what the settings name finds memory; ``instances`` are counted by service."""
    free = psutil.virtual_memory().available if available is None else available
    needed = sum(MEMORY_OF[service] * count for service, count in instances.items())
    what = f"memory: {free / 1e6:,.0f} MB are free"
    if free >= needed:
        return Finding(what)
    return Finding(
        f"{what}, and what the settings name takes about {needed / 1e6:,.0f} MB",
        "end what else runs on this host, or move some of the rig to another",
    )


def clock_finding(*, shared: bool, status: int | None = None, year: int | None = None) -> Finding:
    """Whether the clock is set, and, where the rig is ``shared`` with other hosts, kept right."""
    status = _clock_status() if status is None else status
    if (time.gmtime().tm_year if year is None else year) < LEAST_YEAR:
        return Finding("clock: it has never been set", "set it, and let a time service keep it")
    if status is None:
        return Finding("clock: this system does not say whether anything keeps it right")
    if status & STA_UNSYNC and not shared:
        return Finding("clock: nothing keeps it right, which a rig of one host can do without")
    if status & STA_UNSYNC:
        return Finding(
            "clock: nothing keeps it right, so that times of other hosts do not fit",
            "switch a time service on: `timedatectl set-ntp true`, or chrony",
        )
    return Finding("clock: a time service keeps it right")


def disk_finding(folder: Path, free: int | None = None) -> Finding:
    """Whether a folder's disk has room for recordings."""
    if free is None:
        there = folder.absolute()
        while not there.exists():
            there = there.parent
        free = psutil.disk_usage(str(there)).free
    what = f"disk: {free / 1e9:,.1f} GB are free for {folder}"
    if free >= LEAST_DISK_BYTES:
        return Finding(what)
    return Finding(what, "remove old recordings, or set the recorder's folder to a larger disk")


def hub_findings(settings: ZenohSettings) -> Iterator[Finding]:
    """Whether each address of ``zenoh.connect`` can be reached."""
    for address in settings.connect:
        protocol, _, place = address.partition("/")
        host, _, port = place.rpartition(":")
        if protocol not in ("tcp", "tls"):
            yield Finding(f"hub {address}: only tcp and tls can be tried")
            continue
        try:
            socket.create_connection((host.strip("[]"), int(port)), CONNECT_S).close()
        except OSError as error:
            yield Finding(
                f"hub {address}: cannot be reached ({error.strerror or error})",
                "start it, check the address, and the firewalls between",
            )
        else:
            yield Finding(f"hub {address}: something listens there")


def version_finding() -> Finding:
    """The versions that a report of a fault should name."""
    found = [f"Python {platform.python_version()}"]
    for package in PACKAGES:
        try:
            found.append(f"{package} {importlib.metadata.version(package)}")
        except importlib.metadata.PackageNotFoundError:
            continue  # an extra that is not installed; the settings that need it say so
    return Finding("versions: " + ", ".join(found))


class _Timex(ctypes.Structure):
    """The beginning of the kernel's record of its clock, and room for the rest."""

    _fields_ = [
        ("modes", ctypes.c_uint),
        ("offset", ctypes.c_long),
        ("freq", ctypes.c_long),
        ("maxerror", ctypes.c_long),
        ("esterror", ctypes.c_long),
        ("status", ctypes.c_int),
        ("rest", ctypes.c_byte * 256),
    ]


def _clock_status() -> int | None:
    """The kernel's flags of its clock; None where there is no such kernel."""
    if sys.platform != "linux" or os.name != "posix":
        return None
    record = _Timex()
    if ctypes.CDLL(None).adjtimex(ctypes.byref(record)) < 0:
        return None
    return int(record.status)
