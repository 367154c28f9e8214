"""What a bug report says of a host: its system, the versions of Inhand and its libraries, logs."""

import importlib.metadata
import os
import platform
import re
import shutil
import subprocess
from typing import Any

import psutil

UNITS = "inhand-*"
MOST_LINES = 5000
"""Number of log lines, the last ones, that are worth a report."""
MOST_SAID = 300
"""Number of characters of what the journal says instead."""
JOURNAL_S = 30.0
"""Seconds that the journal, which may be on a slow disk, has to answer."""


def system() -> dict[str, Any]:
    """Return the kind of system, and how much memory and how many cores it has."""
    try:
        release = platform.freedesktop_os_release().get("PRETTY_NAME", "")
    except OSError:
        release = ""
    return {
        "system": release or platform.system(),
        "kernel": platform.release(),
        "machine": platform.machine(),
        "python": platform.python_version(),
        "cores": os.cpu_count(),
        "memory_bytes": psutil.virtual_memory().total,
        "free_memory_bytes": psutil.virtual_memory().available,
    }


def versions() -> dict[str, str | None]:
    """Return the version of Inhand and of each library of it; None for one that is missing."""
    names = {"inhand"}
    for line in importlib.metadata.requires("inhand") or ():
        if "extra == 'dev'" not in line.replace('"', "'") and (name := re.match(r"[\w.-]+", line)):
            names.add(name[0])
    return {name: _version(name) for name in sorted(names)}


def journal() -> tuple[str, str | None]:
    """Return the last lines of the journal of Inhand's units, and why there are none, if so."""
    if shutil.which("journalctl") is None:
        return "", "this system has no journal; what `inhand up` wrote stands in its terminal"
    command = ["journalctl", f"--unit={UNITS}", f"--lines={MOST_LINES}", "--no-pager"]
    try:
        done = subprocess.run(
            [*command, "--quiet", "--output=short-iso-precise"],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=JOURNAL_S,
            check=False,
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        return "", f"the journal cannot be read: {type(error).__name__}"
    text, said = (stream.decode(errors="replace") for stream in (done.stdout, done.stderr))
    if text.strip():
        return text, None
    why = f" ({said.strip()[:MOST_SAID]})" if said.strip() else ""
    return "", (
        f"the journal shows nothing of {UNITS}{why}: systemd ran nothing, or you may not read it: "
        "run this as root, or join the group systemd-journal"
    )


def _version(name: str) -> str | None:
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return None
