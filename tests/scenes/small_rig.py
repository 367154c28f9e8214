"""A small recording of a rig: one camera with pictures and depth, a skeleton, and a mug's poses."""

import math
from pathlib import Path

import numpy as np
from inhand_recorder.losses import LOSSES_RECORD, LossCounter, format_losses
from inhand_runtime.pixels import encode_colour, encode_depth
from inhand_runtime.recording import RecordingWriter
from inhand_schemas.keys import Site
from inhand_schemas.messages import (
    CameraInfo,
    Message,
    ObjectPose,
    Person,
    Pose,
    RgbdFrame,
    Skeletons,
)
from inhand_schemas.topics import INFO, LABEL, POSE, RGBD, SKELETONS, AnyTopic
from numpy.typing import NDArray

SITE = Site()
START_NS = 1_700_000_000_123_456_789
FRAME_NS = 33_333_333
DELAY_NS = 2_000_000
WIDTH, HEIGHT = 64, 48
DEPTH_SCALE = 0.001
CAMERA = CameraInfo(
    sequence=0,
    time_ns=START_NS,
    width=WIDTH,
    height=HEIGHT,
    fx=60.0,
    fy=61.0,
    cx=31.5,
    cy=23.5,
    depth_scale=DEPTH_SCALE,
    rig_from_camera=Pose((0.0, 0.5, 1.5), (math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0)),
)


def depth_of(number: int) -> NDArray[np.uint16]:
    """(H, W) millimetres of a frame, with a hole."""
    depth = np.arange(WIDTH * HEIGHT, dtype=np.uint16).reshape(HEIGHT, WIDTH) + 700 + number
    depth[:4, :4] = 0
    return depth


def colour_of(number: int) -> NDArray[np.uint8]:
    """(H, W, 3) RGB of a frame."""
    colour = np.full((HEIGHT, WIDTH, 3), 40, np.uint8)
    colour[:, number % WIDTH :, 0] = 200
    return colour


def pose_of(number: int) -> Pose:
    """camera_from_object of a frame: it moves and turns."""
    angle = 0.1 * number
    return Pose(
        (0.01 * number, -0.02, 0.8 + 0.001 * number),
        (math.cos(angle), math.sin(angle) / math.sqrt(2), 0.0, math.sin(angle) / math.sqrt(2)),
    )


def joints_of(number: int) -> tuple[tuple[float, float, float], ...]:
    """Joints (20, 3) of a frame in the camera frame; the last one is missing."""
    return (*((0.05 * joint, 0.01 * number, 1.5) for joint in range(19)), (0.0, 0.0, 0.0))


def messages_of(number: int) -> list[tuple[AnyTopic, str, Message]]:
    """The messages of one frame; in each fifth the object is lost."""
    stamp = {"sequence": number, "time_ns": START_NS + number * FRAME_NS}
    colour, depth = encode_colour(colour_of(number)), encode_depth(depth_of(number))
    person = Person(
        id=7,
        joints=joints_of(number),
        states=(*["tracked"] * 18, "inferred", "missing"),
        confidences=(*[1.0] * 18, 0.5, 0.0),
    )
    about = {**stamp, "object": "mug", "camera": "front", "person": 7}
    lost = number % 5 == 4
    pose = ObjectPose(
        **about,
        state="lost" if lost else "tracked",
        confidence=0.0 if lost else 0.75,
        camera_from_object=None if lost else pose_of(number),
    )
    label = ObjectPose(**about, state="tracked", confidence=1.0, camera_from_object=pose_of(number))
    return [
        (RGBD, "front", RgbdFrame(**stamp, colour=colour, depth=depth)),
        (SKELETONS, "front", Skeletons(**stamp, people=(person,), convention="kinect_v1")),
        (LABEL, "mug", label),
        (POSE, "mug", pose),
    ]


def write_rig(
    path: Path, *, first: int = 0, frames: int = 10, site: Site = SITE, sync_every: int = 4
) -> Path:
    """Write a whole recording at 30 Hz, which begins with the camera's info as each file does."""
    path.parent.mkdir(exist_ok=True)
    counter = LossCounter()
    with RecordingWriter(path) as writer:
        writer.add_metadata("session", {"participant": "p01"})

        def write(topic: AnyTopic, name: str, message: Message, received_ns: int) -> None:
            key = topic.key(site, name)
            times = {"received_ns": received_ns, "captured_ns": message.time_ns}
            writer.write(key, topic.encode(message), sequence=message.sequence, **times)
            counter.count(key, message.sequence)

        write(INFO, "front", CAMERA, START_NS + first * FRAME_NS + DELAY_NS)
        for number in range(first, first + frames):
            for place, (topic, name, message) in enumerate(messages_of(number)):
                write(topic, name, message, message.time_ns + DELAY_NS * (1 + place))
            if number % sync_every == sync_every - 1:
                writer.sync()
        writer.add_metadata(LOSSES_RECORD, format_losses(counter.losses()))
    return path
