"""What of a rig's host a fault can change: its wall clock, and whether its camera is plugged in."""

import os
import shutil
import struct
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inhand_tracker.geometry.arrays import Array

CLOCK_VARIABLE = "CHAOS_CLOCK"
STEPPED = Path(__file__).with_name("stepped") / "sitecustomize.py"
ENTRY_POINTS = "[inhand.sources]\npluggable = inhand_lab.chaos.pluggable:PluggableSource\n"
METADATA = "Metadata-Version: 2.1\nName: chaos\nVersion: 1.0\n"


class HostClock:
    """The wall clock that the processes of a rig read: this machine's, and what it was set by.

    No clock of this machine is set: Python's ``time`` reads another one in those processes.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._offsets_s = [0.0]
        path.write_bytes(bytes(8))

    def step(self, by_s: float) -> None:
        """Set it by some seconds."""
        self._offsets_s.append(self._offsets_s[-1] + by_s)
        with self._path.open("r+b") as file:
            file.write(struct.pack("q", round(1e9 * self._offsets_s[-1])))

    def true_times(self, stamps: Array, came: Array) -> Array:
        """What this machine's clock read (N,) at moments that were stamped by a rig's clock: of all
        that its settings allow those that are latest, and not after the messages ``came`` (N,)."""
        times = stamps - np.array([sorted(set(self._offsets_s))]).T
        times[times > came] = -np.inf
        latest: Array = times.max(axis=0)
        return np.where(np.isfinite(latest), latest, stamps)


@dataclass(frozen=True)
class Host:
    """The host of a rig: its ``clock``, and the ``plug`` of its camera, a file that is there while
    the camera is."""

    folder: Path
    clock: HostClock
    plug: Path

    @property
    def environment(self) -> Mapping[str, str]:
        """What its processes have in their environment."""
        before = os.environ.get("PYTHONPATH")
        return {
            **os.environ,
            CLOCK_VARIABLE: str(self.folder / "clock"),
            "PYTHONPATH": os.pathsep.join(filter(None, (str(self.folder), before))),
        }


def new_host(folder: Path) -> Host:
    """Make a host in a folder: its clock reads what this machine's does, its camera is there."""
    described = folder / "chaos-1.0.dist-info"
    described.mkdir(parents=True)
    (described / "METADATA").write_text(METADATA, encoding="utf-8")
    (described / "entry_points.txt").write_text(ENTRY_POINTS, encoding="utf-8")
    shutil.copy(STEPPED, folder)
    plug = folder / "plug"
    plug.touch()
    return Host(folder, HostClock(folder / "clock"), plug)
