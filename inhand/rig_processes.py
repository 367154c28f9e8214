"""Which processes the settings of a rig name, and by what each is another one than before."""

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from inhand_runtime.errors import SettingsError
from inhand_runtime.settings import RigFile

STOP_ORDER = ("studio", "capture", "tracker", "outcomes", "recorder", "hub")
"""Services in the order in which they stop, so that what is under way reaches the last."""


@dataclass(frozen=True)
class RigProcess:
    """One instance of a service: its name, the command that starts it, and all settings that it
    reads."""

    name: str
    command: tuple[str, ...]
    settings: tuple[Any, ...]


def rig_processes(rig_file: RigFile, config: Path | None) -> list[list[RigProcess]]:
    """Return the processes of a rig, service by service as they stop; raises SettingsError when
    there is nothing to run."""
    if rig_file.hub and meets_without_hub(rig_file):
        raise SettingsError(
            f"{config} names a hub, and processes that would never meet there: let each join "
            "(`inhand hub add`), with the settings file that this prints, and leave the hub alone "
            "in its own"
        )
    stages = [_of_service(rig_file, config, service) for service in STOP_ORDER]
    if not any(stages):
        raise SettingsError(
            f"{config or 'the settings'} names no process: add a table such as [capture.front], "
            "or give --config"
        )
    return stages


def meets_without_hub(rig_file: RigFile) -> bool:
    """Whether processes of a file meet by themselves, as peers."""
    services = (service for service in STOP_ORDER if service != "hub")
    return rig_file.zenoh.mode == "peer" and any(getattr(rig_file, one) for one in services)


def _of_service(rig_file: RigFile, config: Path | None, service: str) -> list[RigProcess]:
    file = () if config is None else ("--config", str(config))
    shared = (rig_file.realm, rig_file.rig, rig_file.zenoh, rig_file.log)
    return [
        RigProcess(
            f"{service} {instance}",
            (sys.executable, "-m", "inhand", service, *file, "--name", instance),
            (*shared, table, _calibration(table, config)),
        )
        for instance, table in getattr(rig_file, service).items()
    ]


def _calibration(table: dict[str, Any], config: Path | None) -> bytes | None:
    """Content of the calibration file that a table names: its camera starts anew where that
    changed, too. None where there is none, or it cannot be read, which the camera's check says."""
    name = table.get("calibration")
    if not isinstance(name, str):
        return None
    try:
        return (Path() if config is None else config.parent).joinpath(name).read_bytes()
    except OSError:
        return None
