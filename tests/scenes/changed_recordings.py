"""A recording of somebody who waves a box, with one thing in it changed."""

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import msgspec
from inhand_runtime.recording import RecordingWriter
from inhand_schemas.keys import Site
from inhand_schemas.messages import (
    CameraInfo,
    Message,
    ObjectPose,
    Pose,
    RgbdFrame,
    Skeletons,
)
from inhand_schemas.topics import INFO, LABEL, RGBD, SKELETONS
from waving import messages

TOPICS: dict[type[Message], Any] = {
    CameraInfo: INFO,
    Skeletons: SKELETONS,
    ObjectPose: LABEL,
    RgbdFrame: RGBD,
}
replace = msgspec.structs.replace
Change = Callable[[Any], Message | None]


def write_recording(path: Path, change: Change, frames: int = 30) -> Path:
    """Write what ``change`` makes of each message; None leaves it out."""
    return write_messages(path, (change(message) for message in messages(frames, 0)))


def write_messages(
    path: Path, changed: Iterable[Message | None], *, also: str | None = None
) -> Path:
    """Write messages in their order, whatever they say; ``also`` names a second camera of all."""
    cameras = ["camera"] if also is None else ["camera", also]
    with RecordingWriter(path) as writer:
        for number, message in enumerate(changed):
            if message is not None:
                topic = TOPICS[type(message)]
                names = [message.object] if isinstance(message, ObjectPose) else cameras
                for name in names:
                    writer.write(
                        topic.key(Site(), name),
                        msgspec.msgpack.encode(message),
                        received_ns=number,
                        captured_ns=message.time_ns,
                        sequence=message.sequence,
                    )
    return path


def with_times(change: Callable[[int, int], int]) -> Change:
    """Change every time, given it and the frame's number."""
    return lambda one: replace(one, time_ns=change(one.time_ns, one.sequence))


def with_joints(change: Callable[[float], float], frames: Iterable[int] | None = None) -> Change:
    """Change every coordinate of the joints, in some frames or in all."""

    def changed(message: Message) -> Message:
        if not isinstance(message, Skeletons) or (frames and message.sequence not in frames):
            return message
        people = tuple(
            replace(one, joints=tuple(tuple(map(change, joint)) for joint in one.joints))
            for one in message.people
        )
        return replace(message, people=people)

    return changed


def with_labels(change: Callable[[ObjectPose], ObjectPose]) -> Change:
    """Change the labels alone."""
    return lambda one: change(one) if isinstance(one, ObjectPose) else one


def scaled(label: ObjectPose, factor: float) -> ObjectPose:
    """Return a label whose place is in another unit."""
    pose = label.camera_from_object
    assert pose is not None
    x, y, z = pose.translation
    place = (factor * x, factor * y, factor * z)
    return replace(label, camera_from_object=Pose(place, pose.rotation))
