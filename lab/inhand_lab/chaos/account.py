"""What a recorder kept of the time in which faults were inflicted."""

import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inhand_runtime.recording import RecordingError, read_recording
from inhand_schemas.topics import SKELETONS
from inhand_tracker.geometry.arrays import Array

from inhand_lab.chaos.rig import INHAND
from inhand_lab.chaos.trials import Trial


def recorded_skeletons(folder: Path) -> Array:
    """Return the stamps of the skeletons of all recordings of a folder (N,), in seconds; files that
    were cut off are recovered first, as people do."""
    times: list[float] = []
    for path in sorted(folder.glob("*.mcap*")):
        times += _captured(path, folder)
    return np.array(times)


def _captured(path: Path, folder: Path) -> list[float]:
    try:
        return _read(path)
    except RecordingError:
        saved = folder / f"{path.name}.saved"
        subprocess.run(
            [*INHAND, "recording", "recover", str(path), "-o", str(saved)],
            stdout=subprocess.DEVNULL,
            check=True,
        )
        return _read(saved)


def _read(path: Path) -> list[float]:
    streams = (SKELETONS.stream,)
    return [one.captured_ns / 1e9 for one in read_recording(path, streams=streams)]


@dataclass(frozen=True)
class Unrecorded:
    """How many of a trial's skeletons are in no recording, and how many seconds before the fault
    the first of these was captured; 0 where nothing from before it is missing."""

    skeletons: int
    before_s: float


def unrecorded(trial: Trial, recorded: Array) -> Unrecorded:
    """Compare what came in a trial with the stamps of what was ``recorded`` (N,), in seconds."""
    missing = trial.skeletons.captured[~np.isin(trial.skeletons.stamps, recorded)]
    if len(missing) == 0:
        return Unrecorded(0, 0.0)
    return Unrecorded(len(missing), max(trial.span.begin - float(missing.min()), 0.0))
