"""Names of recordings, ``{rig}_{UTC time}.mcap``."""

from datetime import UTC, datetime
from pathlib import Path

SUFFIX = ".mcap"


def free_path(folder: Path, rig: str, began_ns: int) -> Path:
    """Return a path in the folder that neither a recording nor one under way has; the time is in
    nanoseconds since the epoch."""
    began = datetime.fromtimestamp(began_ns / 1e9, UTC).strftime("%Y%m%dT%H%M%SZ")
    name, number = f"{rig}_{began}", 1
    while any(folder.glob(f"{name}{SUFFIX}*")):
        number += 1
        name = f"{rig}_{began}_{number}"
    return folder / f"{name}{SUFFIX}"
