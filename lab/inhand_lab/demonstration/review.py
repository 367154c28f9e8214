"""Reviews a rig's recording: traffic, latency, and errors where truth was recorded."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

import numpy as np
from inhand_runtime.recording import RecordedMessage, read_metadata, read_recording
from inhand_schemas.keys import parse_key
from inhand_schemas.messages import Health, ObjectPose
from inhand_schemas.topics import HEALTH, LABEL, POSE, SKELETONS, topic_of
from inhand_tracker.geometry.arrays import Array

from inhand_lab.evaluation.vertex_error import vertex_error


class FrameName(NamedTuple):
    """Which frame of which camera a pose, or a label, is of."""

    camera: str
    sequence: int


@dataclass(frozen=True)
class Traffic:
    """Numbers of messages of one stream, over all of its keys."""

    published: int
    received: int
    recorded: int
    lost: int


@dataclass(frozen=True)
class Review:
    """The results of a review.

    ``traffic`` is by stream, without health. ``latencies_ms`` (P,) are from a frame's capture to
    its pose at the recorder. ``frames`` are the S frames with both a pose and a label,
    ``vertex_errors_m`` (S,) their errors. ``skipped_frames`` is how many frames the tracker
    left out because it was behind.
    """

    traffic: dict[str, Traffic]
    latencies_ms: Array
    frames: Sequence[FrameName]
    vertex_errors_m: Array
    poses: dict[FrameName, ObjectPose]
    labels: dict[FrameName, ObjectPose]
    skipped_frames: int


@dataclass
class _Contents:
    """The messages that one pass over a recording collects."""

    object_name: str
    recorded: Counter[str] = field(default_factory=Counter)
    health: dict[str, Health] = field(default_factory=dict)
    poses: dict[FrameName, ObjectPose] = field(default_factory=dict)
    labels: dict[FrameName, ObjectPose] = field(default_factory=dict)
    latencies_ms: list[float] = field(default_factory=list)

    def take(self, sample: RecordedMessage) -> None:
        """Count one message, and keep it where it says something of health or of the object."""
        self.recorded[sample.key] += 1
        if sample.topic is POSE:
            self.latencies_ms.append((sample.received_ns - sample.captured_ns) / 1e6)
        if sample.topic is HEALTH:
            message = sample.message()
            if isinstance(message, Health):
                self.health[message.instance + message.service] = message
        elif sample.topic in (POSE, LABEL) and sample.name == self.object_name:
            message = sample.message()
            if isinstance(message, ObjectPose):
                kept = self.poses if sample.topic is POSE else self.labels
                kept[FrameName(message.camera, message.sequence)] = message


def review(path: Path, object_name: str, marked_vertices: Array) -> Review:
    """Review a whole recording; raises RecordingError."""
    contents = _Contents(object_name)
    for sample in read_recording(path):
        contents.take(sample)
    poses, labels = contents.poses, contents.labels
    frames = [
        frame
        for frame, pose in poses.items()
        if pose.camera_from_object is not None and frame in labels
    ]
    errors = [
        float(vertex_error(_pose(poses[one]), _pose(labels[one]), marked_vertices))
        for one in frames
    ]
    return Review(
        _traffic(
            contents.recorded, contents.health.values(), read_metadata(path).get("losses", {})
        ),
        np.array(contents.latencies_ms),
        frames,
        np.array(errors),
        poses,
        labels,
        _skipped(contents.health.values()),
    )


def _skipped(instances: Iterable[Health]) -> int:
    """How many skeletons trackers left out because newer ones had come meanwhile."""
    return sum(
        topic.dropped
        for one in instances
        if one.service == "tracker"
        for key, topic in one.topics.items()
        if parse_key(key).stream == SKELETONS.stream
    )


def _traffic(
    recorded: Counter[str], health: Iterable[Health], losses: Mapping[str, str]
) -> dict[str, Traffic]:
    """Traffic by stream: published by what instances last reported, received by the recorder."""
    instances = list(health)
    streams: dict[str, Traffic] = {}
    for key in sorted(recorded):
        stream = parse_key(key).stream
        if stream == HEALTH.stream:
            continue
        published = sum(one.topics[key].published for one in instances if key in one.topics)
        noted = dict(entry.split("=") for entry in losses.get(key, "").split())
        before = streams.get(stream, Traffic(0, 0, 0, 0))
        streams[stream] = Traffic(
            before.published + published,
            # A number twice in a row is noted once: of labels it may be that of another camera.
            before.received + max(int(noted.get("received", 0)), recorded[key]),
            before.recorded + recorded[key],
            before.lost + _lost(key, published - recorded[key], int(noted.get("lost", 0))),
        )
    return streams


def _lost(key: str, unrecorded: int, missing_numbers: int) -> int:
    """Messages of a key that were lost: by what was published and, where they say it, by gaps."""
    topic, _ = topic_of(key)
    return max(unrecorded, missing_numbers if topic.gaps_are_losses else 0)


def _pose(message: ObjectPose) -> tuple[Array, Array]:
    pose = message.camera_from_object
    if pose is None:
        raise ValueError("a lost object has no pose")
    return np.array(pose.translation), np.array(pose.rotation)
