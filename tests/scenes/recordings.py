"""Small recordings to damage."""

from pathlib import Path

from inhand_recorder.losses import LOSSES_RECORD, LossCounter, format_losses
from inhand_recorder.verification import verify_recording
from inhand_runtime.recording import RecordedMessage, RecordingWriter, read_recording
from inhand_schemas.keys import Site
from inhand_schemas.messages import ColourImage, Message, ObjectPose, RgbdFrame, Skeletons
from inhand_schemas.topics import POSE, RGBD, SKELETONS, AnyTopic
from mcap.writer import CompressionType, Writer

SITE = Site()
START_NS = 1_700_000_000_000_000_000
FRAME_NS = 33_333_333
RGBD_KEY = RGBD.key(SITE, "kitchen")
SKELETONS_KEY = SKELETONS.key(SITE, "kitchen")
POSE_KEY = POSE.key(SITE, "mug")


def frame_messages(number: int, image_bytes: int) -> list[tuple[str, Message, bytes]]:
    """The messages of one frame with their keys and payloads."""
    stamp = {"sequence": number, "time_ns": START_NS + number * FRAME_NS}
    pixels = bytes((number + i) % 251 for i in range(image_bytes))
    frame = RgbdFrame(**stamp, colour=ColourImage("jpeg", 64, 48, pixels))
    pose = ObjectPose(**stamp, object="mug", camera="kitchen", state="lost", confidence=0.0)
    skeletons = Skeletons(**stamp)
    return [
        (RGBD_KEY, frame, RGBD.encode(frame)),
        (SKELETONS_KEY, skeletons, SKELETONS.encode(skeletons)),
        (POSE_KEY, pose, POSE.encode(pose)),
    ]


def write_frame(writer: RecordingWriter, counter: LossCounter, number: int, size: int) -> None:
    """Record the messages of one frame, 2 ms after its capture."""
    for key, message, payload in frame_messages(number, size):
        writer.write(
            key,
            payload,
            received_ns=message.time_ns + 2_000_000,
            captured_ns=message.time_ns,
            sequence=message.sequence,
        )
        counter.count(key, message.sequence)


def write_message(writer: RecordingWriter, topic: AnyTopic, name: str, message: Message) -> None:
    """Record a message under a name, 5 ns after its capture."""
    writer.write(
        topic.key(SITE, name),
        topic.encode(message),  # type: ignore[arg-type]
        received_ns=message.time_ns + 5,
        captured_ns=message.time_ns,
        sequence=message.sequence,
    )


def write_recording(
    path: Path, *, frames: int = 30, image_bytes: int = 200, frames_a_chunk: int = 10
) -> Path:
    """A whole recording at 30 Hz of three keys, in several chunks."""
    counter = LossCounter()
    with RecordingWriter(path) as writer:
        writer.add_metadata("session", {"participant": "p01"})
        for number in range(frames):
            write_frame(writer, counter, number, image_bytes)
            if number % frames_a_chunk == frames_a_chunk - 1:
                writer.sync()
        writer.add_metadata(LOSSES_RECORD, format_losses(counter.losses()))
    return path


def damaged_copy(folder: Path, data: bytes) -> Path:
    """A recording of these bytes."""
    path = folder / "damaged.mcap"
    path.write_bytes(data)
    return path


def flaws(path: Path) -> list[str]:
    """What is wrong with a recording, but that these small ones have no camera's info."""
    return [line for line in verify_recording(path) if "have no camera info" not in line]


def contents(path: Path) -> list[tuple[str, bytes, int, int, int]]:
    """All that a recording says, message by message."""
    return [identity(message) for message in read_recording(path)]


def identity(message: RecordedMessage) -> tuple[str, bytes, int, int, int]:
    """What makes a message the same one."""
    return (
        message.key,
        message.payload,
        message.received_ns,
        message.captured_ns,
        message.sequence,
    )


def write_without_checksums(path: Path, *, damaged: int) -> None:
    """Write 20 poses as a program without checksums does, and spoil one of them."""
    with path.open("wb") as file:
        writer = Writer(file, compression=CompressionType.NONE)
        writer.start(profile="inhand")
        channel = writer.register_channel(POSE_KEY, "msgpack", 0)
        for number in range(20):
            payload = frame_messages(number, 1)[2][2]
            writer.add_message(channel, START_NS + number, payload, START_NS, number)
        writer.finish()
    data = bytearray(path.read_bytes())
    place = data.index(frame_messages(damaged, 1)[2][2])
    data[place : place + 64] = bytes(64)
    path.write_bytes(data)
