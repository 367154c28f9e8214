"""A recording of somebody who waves a box, and keyframes of the box."""

from pathlib import Path
from typing import Any

import msgspec
from changed_recordings import write_messages
from inhand_lab.labelling.keyframes import Keyframe, KeyframeFile
from inhand_schemas.messages import Message, ObjectPose, Pose
from inhand_tracker.shape.shape import save_shape
from waving import FRAME_NS, START_NS, box, messages

FRAMES = 31


def pose(x: float = 0.0, y: float = 0.0, z: float = 2.0) -> Pose:
    return Pose((x, y, z), (1.0, 0.0, 0.0, 0.0))


def key(frame: int, at: Pose | None, **values: Any) -> Keyframe:
    time_ns = START_NS + frame * FRAME_NS
    return Keyframe(**{"frame": frame, "time_ns": time_ns, "camera_from_object": at, **values})


def file_of(*keyframes: Keyframe, **values: Any) -> KeyframeFile:
    usual = {"recording": "wave.mcap", "object": "box", "camera": "camera"}
    return KeyframeFile(**{**usual, "keyframes": keyframes, **values})


def unlabelled(frames: int = FRAMES) -> list[Message]:
    return [one for one in messages(frames, 0) if not isinstance(one, ObjectPose)]


def dataset(folder: Path, shown: list[Message] | None = None) -> Path:
    """Write the box and the recording into a dataset's folder; returns the recording."""
    save_shape(box(), folder / "objects" / "box")
    (folder / "recordings").mkdir()
    path = folder / "recordings" / "wave.mcap"
    return write_messages(path, unlabelled() if shown is None else shown)


def later(message: Message, by_ns: int) -> Message:
    return msgspec.structs.replace(message, time_ns=message.time_ns + by_ns)
