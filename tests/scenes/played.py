"""Small recordings to play."""

from collections.abc import Collection, Iterable
from pathlib import Path

from inhand_runtime.recording import RecordingWriter
from inhand_schemas.keys import Site
from inhand_schemas.messages import (
    CameraInfo,
    ColourImage,
    DepthImage,
    Message,
    ObjectPose,
    RgbdFrame,
    Skeletons,
)
from inhand_schemas.topics import INFO, LABEL, RGBD, SKELETONS, AnyTopic
from scripted_source import PERSON

START_NS = 1_600_000_000_000_000_000
FRAME_NS = 20_000_000
RECEIVED_LATER_NS = 3_000_000
CAMERA_INFO = CameraInfo(
    sequence=0, time_ns=START_NS, width=64, height=48, fx=50, fy=50, cx=32, cy=24, frame_rate=50
)
PICTURE = ColourImage("jpeg", 64, 48, b"any bytes")
DEPTH = DepthImage("z16-zstd", 64, 48, b"other bytes")

Entry = tuple[AnyTopic, str, Message]


def frame_entries(number: int, camera: str = "kitchen") -> list[Entry]:
    """What one frame leaves in a recording, in the order in which capture sends it."""
    stamp = {"sequence": 100 + number, "time_ns": START_NS + number * FRAME_NS}
    label = ObjectPose(**stamp, object="mug", camera=camera, state="lost", confidence=1.0)
    return [
        (SKELETONS, camera, Skeletons(**stamp, people=(PERSON,), convention="kinect_v2")),
        (LABEL, "mug", label),
        (RGBD, camera, RgbdFrame(**stamp, time_uncertainty_ns=7, colour=PICTURE, depth=DEPTH)),
    ]


def entries(
    frames: int, *, without: Collection[AnyTopic] = (), camera: str = "kitchen"
) -> list[Entry]:
    """A camera's info and so many frames, at 50 Hz."""
    found: list[Entry] = [(INFO, camera, CAMERA_INFO)]
    for number in range(frames):
        found += frame_entries(number, camera)
    return [entry for entry in found if entry[0] not in without]


def write(path: Path, recorded: Iterable[Entry]) -> Path:
    """A recording of these messages, received in this order 3 ms after capture."""
    received_ns = 0
    with RecordingWriter(path) as writer:
        for topic, name, message in recorded:
            received_ns = max(received_ns, message.time_ns + RECEIVED_LATER_NS)
            writer.write(
                topic.key(Site(), name),
                topic.encode(message),
                received_ns=received_ns,
                captured_ns=message.time_ns,
                sequence=message.sequence,
            )
    return path
