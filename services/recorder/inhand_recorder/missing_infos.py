"""A recording that lacks its cameras' info gets it from another one."""

from pathlib import Path

from inhand_runtime.recording import (
    RecordedMessage,
    RecordingError,
    RecordingWriter,
    read_metadata,
    read_recording,
)
from inhand_runtime.recording.copying import copy_message
from inhand_schemas.topics import INFO, RGBD, SKELETONS

from inhand_recorder.attachments import copy_attachments


def add_infos(path: Path, info_from: Path, output: Path) -> tuple[str, ...]:
    """Write ``path`` with the infos that it lacks to the new file ``output``; returns the cameras.

    Raises RecordingError where nothing is lacking, or the other recording has none of the cameras;
    neither input is ever changed.
    """
    cameras, infos = _cameras(path)
    lacking = sorted(cameras - infos.keys())
    if not lacking:
        raise RecordingError(f"{path} lacks no camera's info: nothing is to be repaired")
    _, others = _cameras(info_from)
    if missing := [camera for camera in lacking if camera not in others]:
        there = ", ".join(sorted(others)) or "none"
        raise RecordingError(f"{info_from} holds no info of {missing[0]}: it has {there}")
    with RecordingWriter(output) as writer:
        begun = False
        for message in read_recording(path, apart=True):
            if not begun:
                for camera in lacking:
                    _write(writer, others[camera], received_ns=message.received_ns)
                begun = True
            copy_message(writer, message)
        for name, values in read_metadata(path).items():
            writer.add_metadata(name, values)
        copy_attachments(writer, path)
        writer.add_metadata("repair", {"source": path.name, "info_from": info_from.name})
    return tuple(lacking)


def _cameras(path: Path) -> tuple[set[str], dict[str, RecordedMessage]]:
    """The cameras that frames or skeletons come from, and their infos."""
    cameras: set[str] = set()
    infos: dict[str, RecordedMessage] = {}
    for message in read_recording(path, streams=(INFO.stream, RGBD.stream, SKELETONS.stream)):
        if message.topic is INFO:
            infos[message.name] = message
        else:
            cameras.add(message.name)
    return cameras, infos


def _write(writer: RecordingWriter, message: RecordedMessage, *, received_ns: int) -> None:
    writer.write(
        message.key,
        message.payload,
        received_ns=received_ns,
        captured_ns=message.captured_ns,
        sequence=message.sequence,
    )
