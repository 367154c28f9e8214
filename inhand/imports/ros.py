"""Bags of ROS 1 and 2, and MCAP files with messages of ROS 2: colour, depth and the lens."""

from __future__ import annotations

import struct
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import msgspec
from inhand_runtime.errors import InhandError
from inhand_runtime.pixels import decode_depth, encode_depth
from inhand_schemas.keys import require_name
from inhand_schemas.messages import CameraInfo, ColourImage, DepthImage
from inhand_schemas.topics import INFO, RGBD
from rosbags.highlevel import AnyReader
from rosbags.interfaces import Connection

from inhand.imports.alignment import DepthAlignment
from inhand.imports.foreign import ForeignMessage, LeftOut
from inhand.imports.pairing import FrameAssembler, Stream, Times, frame_rate, paired_frames
from inhand.imports.realsense import (
    RealSenseStream,
    alignment_of,
    capture_times,
    depth_units,
    device_name,
    lens_of,
    lens_topic,
    realsense_streams,
)
from inhand.imports.ros_bag import IMAGE, first_message, messages_of, messages_on, read_message
from inhand.imports.ros_images import DEPTH_SCALE, colour_of, depth_of, info_of, is_depth
from inhand.progress import progress_bar

IMAGES = (IMAGE, "sensor_msgs/msg/CompressedImage")
UNKNOWN = -1
"""A time of capture that is nowhere."""
TimesInBag = Mapping[str, Mapping[int, int]]
LENS = "sensor_msgs/msg/CameraInfo"
_STAMPS = {True: struct.Struct("<4xiI"), False: struct.Struct("<4xII")}
"""Where a message's header has its time: of ROS 2, and of ROS 1."""


@dataclass(frozen=True)
class RosTopics:
    """The topics that a camera's frames come from; None where there is no such images."""

    colour: str | None
    depth: str | None
    camera_info: str


@dataclass
class RosBag:
    """An open bag with the topics that are read, and how its frames are paired.

    ``frames`` has each frame's time of capture by the times of its images, colour and depth, -1
    where it has none of these. ``info`` is the lens, ``align`` makes depth of another view depth of
    the colour's; ``device`` is a RealSense's model, whose bags do not say when they received what,
    and ``taken_ns`` when images were taken by topic and time in the bag, where headers do not.
    """

    reader: AnyReader
    topics: RosTopics
    frames: list[Times]
    info: CameraInfo
    align: DepthAlignment | None = None
    device: str | None = None
    taken_ns: TimesInBag = field(default_factory=dict)
    left_out: LeftOut = field(default_factory=LeftOut)

    def messages(self, camera: str) -> Iterator[ForeignMessage]:
        """Yield the camera's info and its frames, each when its last image was received."""
        require_name("camera", camera)
        assembler, latest_ns = FrameAssembler(self.frames), -1
        for connection, bag_ns, raw in messages_on(
            self.reader, self.topics.colour, self.topics.depth
        ):
            captured_ns = _captured(self.reader, self.taken_ns, connection.topic, bag_ns, raw)
            if captured_ns == UNKNOWN:
                continue
            received_ns = max(captured_ns, latest_ns) if self.device else bag_ns
            if latest_ns < 0:
                yield ForeignMessage(INFO, camera, self.info, received_ns)
            latest_ns = received_ns
            stream: Stream = "colour" if connection.topic == self.topics.colour else "depth"
            if not assembler.wants(stream, captured_ns):
                continue
            frame = assembler.put(stream, captured_ns, self._image(stream, connection, raw))
            if frame is not None:
                yield ForeignMessage(RGBD, camera, frame, received_ns)
        if not assembler.made:
            raise InhandError(
                f"no frame of it can be read: {self.left_out.reason or 'it has none'}"
            )

    def _image(
        self, stream: Stream, connection: Connection, raw: bytes
    ) -> ColourImage | DepthImage | None:
        try:
            message = read_message(self.reader, connection, raw)
            if stream == "colour":
                return colour_of(message)
            depth = depth_of(message)
            return depth if self.align is None else encode_depth(self.align(decode_depth(depth)))
        except InhandError as error:
            self.left_out.add(f"{connection.topic}: {error}")
            return None


def plan_import(reader: AnyReader, asked: Mapping[str, str | None]) -> RosBag:
    """Choose the topics of an open bag and pair its images.

    ``asked`` has a topic for ``colour``, ``depth`` and ``camera_info`` where one is chosen. Raises
    InhandError where one is missing, or there are several and none is chosen.
    """
    streams = realsense_streams(reader.connections)
    if streams:
        return _plan_realsense(reader, streams, asked)
    topics = _topics(reader, asked)
    frames = _paired(reader, topics, {})
    return RosBag(reader, topics, frames, _lens(reader, topics.camera_info, frames))


def _plan_realsense(
    reader: AnyReader, streams: Sequence[RealSenseStream], asked: Mapping[str, str | None]
) -> RosBag:
    by_topic = {stream.topic: stream for stream in streams}
    chosen = {
        name: _one(name, [one.topic for one in streams if one.kind == kind], asked[name])
        for name, kind in (("colour", "Color"), ("depth", "Depth"))
    }
    main = by_topic.get(chosen["colour"] or chosen["depth"] or "")
    if main is None:
        raise InhandError(f"neither colour nor depth is in it; its topics are: {_listed(reader)}")
    lens = _one("camera_info", [lens_topic(reader, main)], asked["camera_info"])
    assert lens is not None  # it is the only one
    topics = RosTopics(chosen["colour"], chosen["depth"], lens)
    taken_ns = {topic: capture_times(reader, by_topic[topic]) for topic in chosen.values() if topic}
    frames = _paired(reader, topics, taken_ns)
    if not frames:
        raise InhandError("no image in it says when it was taken")
    since = min(max(frame) for frame in frames), frame_rate(frames)
    info, align, units = lens_of(reader, main, *since), None, DEPTH_SCALE
    if topics.depth is not None:
        depth = by_topic[topics.depth]
        units = depth_units(reader, depth)
        if depth is not main:
            of_depth = lens_of(reader, depth, *since)
            align = alignment_of(reader, (depth, of_depth), (main, info), units)
    device = device_name(reader, main)
    about = {"depth_scale": units, "description": f"{device}, of a bag"}
    info = msgspec.structs.replace(info, **about)
    return RosBag(reader, topics, frames, info, align, device, taken_ns)


def _paired(reader: AnyReader, topics: RosTopics, taken_ns: TimesInBag) -> list[Times]:
    colour, depth = (_times(reader, topic, taken_ns) for topic in (topics.colour, topics.depth))
    return paired_frames(colour, depth)


def _lens(reader: AnyReader, topic: str, frames: Sequence[Times]) -> CameraInfo:
    """Return the lens; raises InhandError where there is none."""
    message = first_message(reader, topic)
    if message is None:
        raise InhandError(f"{topic} has no message")
    return info_of(message, min(max(frame) for frame in frames), frame_rate(frames))


def _topics(reader: AnyReader, asked: Mapping[str, str | None]) -> RosTopics:
    images: dict[str, list[str]] = {"colour": [], "depth": []}
    for connection in reader.connections:
        if connection.msgtype in IMAGES and (message := _first(reader, connection)) is not None:
            of_kind = images["depth" if is_depth(message) else "colour"]
            if connection.topic not in of_kind:
                of_kind.append(connection.topic)
    chosen = {name: _one(name, topics, asked[name]) for name, topics in images.items()}
    if chosen["colour"] is None and chosen["depth"] is None:
        raise InhandError(f"no image is in it; its topics are: {_listed(reader)}")
    lenses = sorted({one.topic for one in reader.connections if one.msgtype == LENS})
    beside = [
        topic
        for image in (chosen["colour"] or chosen["depth"],)
        for topic in lenses
        if image is not None and image.startswith(topic.rpartition("/")[0] + "/")
    ]
    info = _one("camera_info", beside or lenses, asked["camera_info"])
    if info is None:
        raise InhandError(
            f"no CameraInfo is in it, without which nothing can be measured; its topics are: "
            f"{_listed(reader)}"
        )
    return RosTopics(chosen["colour"], chosen["depth"], info)


def _one(name: str, topics: Sequence[str], asked: str | None) -> str | None:
    """Return the topic that is chosen, or the only one; None without any."""
    option = f"--{name.replace('_', '-')}"
    if asked is not None:
        if asked not in topics:
            there = ", ".join(topics) or "none"
            raise InhandError(f"{option} {asked}: there is no such topic; of this kind: {there}")
        return asked
    if len(topics) > 1:
        raise InhandError(f"choose one with {option}: {', '.join(topics)}")
    return topics[0] if topics else None


def _listed(reader: AnyReader) -> str:
    return ", ".join(sorted(f"{one.topic} ({one.msgtype})" for one in reader.connections))


def _first(reader: AnyReader, connection: Connection) -> Any:
    """Return the first message of a connection; None without any."""
    for _, _, raw in messages_of(reader, [connection]):
        return read_message(reader, connection, raw)
    return None


def _times(reader: AnyReader, topic: str | None, taken_ns: TimesInBag) -> list[int]:
    """Return the times of capture of a topic's messages, each once, as they rise."""
    if topic is None:
        return []
    times = set()
    with progress_bar(f"times of {topic}", reader.topics[topic].msgcount) as advance:
        for _, bag_ns, raw in messages_on(reader, topic):
            times.add(_captured(reader, taken_ns, topic, bag_ns, raw))
            advance()
    return sorted(times - {UNKNOWN})


def _captured(reader: AnyReader, taken_ns: TimesInBag, topic: str, bag_ns: int, raw: bytes) -> int:
    """Return when an image was taken, in nanoseconds: by its header, or its time in the bag where
    that says nothing; UNKNOWN where it is to be looked up and is not there."""
    if taken_ns.get(topic):
        return taken_ns[topic].get(bag_ns, UNKNOWN)
    try:
        seconds, rest = _STAMPS[reader.is2].unpack_from(raw)
    except struct.error:
        return bag_ns
    time_ns: int = 1_000_000_000 * seconds + rest
    return time_ns if time_ns > 0 else bag_ns
