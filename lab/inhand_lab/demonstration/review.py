"""What a recording of a rig shows: traffic, latency, and errors where truth was recorded."""

from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inhand_runtime.recording import read_metadata, read_recording
from inhand_schemas.messages import Health, ObjectPose
from inhand_schemas.topics import HEALTH, LABEL, POSE
from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.geometry.estimate import vertex_error


@dataclass(frozen=True)
class Traffic:
    """Messages of one stream, over all of its keys."""

    published: int
    received: int
    recorded: int
    lost: int


@dataclass(frozen=True)
class Review:
    """``traffic`` by stream, health apart.

    ``latencies_ms`` (P,) from a frame's capture to its pose at the recorder; ``sequences`` (S,)
    of the frames with both a pose and a label, with their ``vertex_errors_m`` (S,).
    """

    traffic: dict[str, Traffic]
    latencies_ms: Array
    sequences: Indices
    vertex_errors_m: Array
    poses: dict[int, ObjectPose]
    labels: dict[int, ObjectPose]


def review(path: Path, object_name: str, marked_vertices: Array) -> Review:
    """Review a whole recording; raises RecordingError."""
    recorded: Counter[str] = Counter()
    health: dict[str, Health] = {}
    poses: dict[int, ObjectPose] = {}
    labels: dict[int, ObjectPose] = {}
    latencies = []
    for sample in read_recording(path):
        recorded[sample.key] += 1
        if sample.topic is HEALTH:
            message = sample.message()
            if isinstance(message, Health):
                health[message.instance + message.service] = message
        elif sample.topic in (POSE, LABEL) and sample.name == object_name:
            message = sample.message()
            if isinstance(message, ObjectPose):
                (poses if sample.topic is POSE else labels)[message.sequence] = message
        if sample.topic is POSE:
            latencies.append((sample.received_ns - sample.captured_ns) / 1e6)
    sequences = [
        sequence
        for sequence, pose in poses.items()
        if pose.camera_from_object is not None and sequence in labels
    ]
    errors = [
        float(vertex_error(_pose(poses[s]), _pose(labels[s]), marked_vertices)) for s in sequences
    ]
    return Review(
        _traffic(recorded, list(health.values()), read_metadata(path).get("losses", {})),
        np.array(latencies),
        np.array(sequences, np.int64),
        np.array(errors),
        poses,
        labels,
    )


def _traffic(
    recorded: Counter[str], health: list[Health], losses: dict[str, str]
) -> dict[str, Traffic]:
    """Published is what the instances said last of themselves, received what the recorder noted."""
    streams: dict[str, Traffic] = {}
    for key in sorted(recorded):
        stream = key.split("/")[-2]
        if stream == HEALTH.stream:
            continue
        published = sum(one.topics[key].published for one in health if key in one.topics)
        noted = dict(entry.split("=") for entry in losses.get(key, "").split())
        before = streams.get(stream, Traffic(0, 0, 0, 0))
        streams[stream] = Traffic(
            before.published + published,
            before.received + int(noted.get("received", 0)),
            before.recorded + recorded[key],
            before.lost + max(published - recorded[key], int(noted.get("lost", 0))),
        )
    return streams


def _pose(message: ObjectPose) -> tuple[Array, Array]:
    if message.camera_from_object is None:
        raise ValueError("a lost object has no pose")
    return (
        np.array(message.camera_from_object.translation),
        np.array(message.camera_from_object.rotation),
    )
