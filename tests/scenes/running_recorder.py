"""A recorder as a process, and what it has written."""

from pathlib import Path

from inhand_recorder.inspection import inspect_recording
from inhand_runtime.recording import RecordingError, read_recording
from inhand_schemas.keys import Site
from inhand_schemas.topics import RGBD
from running_rig import Process, RunningRig

RGBD_KEY = RGBD.key(Site(), "front")
"""The key of the frames of ``publisher.py``."""


def start_recorder(rig: RunningRig, settings: str = "") -> Process:
    """A recorder that is up, and writes to ``rig.folder / "disk"``."""
    rig.configure(f'[recorder.disk]\nfolder = "{rig.folder / "disk"}"\n{settings}')
    recorder = rig.inhand("recorder", "--config", rig.config)
    recorder.said("is up")
    return recorder


def recordings(rig: RunningRig, pattern: str = "*.mcap") -> list[Path]:
    """The files of ``start_recorder``."""
    return sorted((rig.folder / "disk").glob(pattern))


def frames_in(rig: RunningRig) -> int:
    """How many frames stand on the disk by now, in files whole or not."""
    try:
        infos = [inspect_recording(path) for path in recordings(rig, "*.mcap*")]
    except RecordingError:  # a file got its final name meanwhile: look again
        return 0
    return sum(key.messages for info in infos for key in info.keys if key.key == RGBD_KEY)


def numbers(paths: list[Path], key: str = RGBD_KEY) -> list[int]:
    """The numbers of a key's messages in whole recordings, file by file."""
    return [m.sequence for path in paths for m in read_recording(path) if m.key == key]
