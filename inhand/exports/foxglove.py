"""Recordings as MCAP files of Foxglove's schemas, which Foxglove, Lichtblick and Rerun show."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from foxglove import messages as fox
from inhand_recorder.recorded import Recorded, RecordedImages
from inhand_runtime.pixels import encode_colour
from inhand_runtime.recording import RecordingError
from inhand_runtime.recording.copying import StandingAlone
from inhand_schemas.errors import MessageError
from inhand_schemas.joints import PARENTS
from inhand_schemas.messages import (
    CameraInfo,
    Event,
    ObjectPose,
    Person,
    Pose,
    Preview,
    Skeletons,
)
from inhand_schemas.topics import HEALTH, LABEL
from mcap.writer import CompressionType, Writer

from inhand.exports.request import ExportRequest
from inhand.exports.unfinished import unfinished

RIG_FRAME = "rig"
"""Name of the frame that cameras stand in."""
LABEL_SUFFIX = "_label"
"""Stands behind an object's name in the frame of its labelled pose."""
MILLIMETRES = 0.001
"""Scale of depth that other programs take ``16UC1`` to have, metres."""


@dataclass(frozen=True)
class SkeletonStyle:
    """How skeletons look: diameters of joints and bones in metres, colour (red, green, blue and
    opacity, 0 to 1), and the seconds that one is shown where no further one follows."""

    joint_m: float = 0.04
    bone_m: float = 0.015
    colour: tuple[float, float, float, float] = (1.0, 0.75, 0.1, 1.0)
    shown_s: float = 0.5


STYLE = SkeletonStyle()


_COLOUR = fox.Color(**dict(zip("rgba", STYLE.colour, strict=True)))


class FoxgloveMessage(Protocol):
    """A message of a schema of Foxglove's."""

    def encode(self) -> bytes:
        """The message as Protobuf."""


Published = tuple[str, FoxgloveMessage]
"""A topic, and a message on it."""


def export_foxglove(request: ExportRequest, output: Path) -> dict[str, int]:
    """Write pictures, depth, calibration, poses, skeletons and events of one rig.

    Times of reception (``log_time``) and capture (``publish_time``) and numbers are those of the
    recording. Returns the numbers of messages by schema, and of images that are damaged.
    """
    request.require_one_rig()
    keys = tuple(key for key in request.keys if request.recording.keys[key] is not HEALTH)
    if not keys:
        raise RecordingError("there is nothing but health: nothing is to be exported")
    damaged = 0
    with unfinished(output) as path, path.open("wb") as file:
        writer = _SchemaWriter(Writer(file, compression=CompressionType.ZSTD))
        videos = StandingAlone()
        for one in request.read(keys):
            try:
                for topic, message in _published(one, videos):
                    writer.write(topic, message, one)
            except MessageError:
                damaged += 1
        writer.finish()
    return {**dict(sorted(writer.counts.items())), "damaged images": damaged}


@dataclass
class _SchemaWriter:
    """Writes messages, each topic with its schema."""

    writer: Writer
    counts: dict[str, int] = field(default_factory=dict)
    _schemas: dict[str, int] = field(default_factory=dict)
    _channels: dict[str, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.writer.start()

    def write(self, topic: str, message: Any, of: Recorded) -> None:
        if topic not in self._channels:
            schema = message.get_schema()
            if schema.name not in self._schemas:
                self._schemas[schema.name] = self.writer.register_schema(
                    schema.name, schema.encoding, schema.data
                )
            self._channels[topic] = self.writer.register_channel(
                topic, "protobuf", self._schemas[schema.name]
            )
        self.writer.add_message(
            self._channels[topic],
            of.received_ns,
            message.encode(),
            of.time_ns,
            of.sequence & 0xFFFFFFFF,
        )
        name = type(message).__name__
        self.counts[name] = self.counts.get(name, 0) + 1

    def finish(self) -> None:
        self.writer.finish()  # type: ignore[no-untyped-call]


def _published(one: Recorded, videos: StandingAlone) -> Iterator[Published]:
    """Yield what a message becomes; raises MessageError for a damaged image.

    Colour as H.264 stays so where ``videos`` has what it builds on.
    """
    message = one.message
    if isinstance(one, RecordedImages):
        yield from _images(one, videos)
    elif isinstance(message, CameraInfo):
        yield f"/{one.name}/calibration", _calibration(one.name, message)
        yield "/tf", _transforms(message.time_ns, RIG_FRAME, one.name, message.rig_from_camera)
    elif isinstance(message, ObjectPose):
        yield from _object(one, message)
    elif isinstance(message, Skeletons):
        yield f"/{one.topic}", _people(one.name, message)
    elif isinstance(message, Preview):
        yield f"/{one.topic}", _compressed(one.name, message.time_ns, message.jpeg)
    elif isinstance(message, Event):
        text = message.description or message.kind
        stamp, level = _timestamp(message.time_ns), fox.LogLevel.Info
        yield "/events", fox.Log(timestamp=stamp, level=level, message=text, name=one.topic)


def _images(one: RecordedImages, videos: StandingAlone) -> Iterator[Published]:
    colour, depth = one.message.colour, one.depth
    if one.coded is not None and videos.stands(one.key, one.coded):
        yield f"/{one.name}/video", _video(one.name, one.time_ns, one.coded.image.data)
    elif one.coded is not None and one.colour is not None:
        jpeg = encode_colour(one.colour).data
        yield f"/{one.name}/colour", _compressed(one.name, one.time_ns, jpeg)
    elif colour is not None and colour.codec == "jpeg":
        yield f"/{one.name}/colour", _compressed(one.name, one.time_ns, colour.data)
    elif colour is not None:
        image = fox.RawImage(
            timestamp=_timestamp(one.time_ns),
            frame_id=one.name,
            width=colour.width,
            height=colour.height,
            encoding="rgb8",
            step=3 * colour.width,
            data=colour.data,
        )
        yield f"/{one.name}/colour_raw", image
    if depth is None:
        return
    metres = one.info is not None and one.info.depth_scale != MILLIMETRES
    pixels = one.depth_m if metres else depth
    if pixels is None:
        return
    encoding, kind = ("32FC1", np.dtype("<f4")) if metres else ("16UC1", np.dtype("<u2"))
    image = fox.RawImage(
        timestamp=_timestamp(one.time_ns),
        frame_id=one.name,
        width=depth.shape[1],
        height=depth.shape[0],
        encoding=encoding,
        step=kind.itemsize * depth.shape[1],
        data=np.ascontiguousarray(pixels, kind).tobytes(),
    )
    yield f"/{one.name}/depth", image


def _compressed(camera: str, time_ns: int, jpeg: bytes) -> fox.CompressedImage:
    return fox.CompressedImage(
        timestamp=_timestamp(time_ns), frame_id=camera, data=jpeg, format="jpeg"
    )


def _video(camera: str, time_ns: int, picture: bytes) -> fox.CompressedVideo:
    return fox.CompressedVideo(
        timestamp=_timestamp(time_ns), frame_id=camera, data=picture, format="h264"
    )


def _calibration(camera: str, info: CameraInfo) -> fox.CameraCalibration:
    lens = [info.fx, 0.0, info.cx, 0.0, info.fy, info.cy, 0.0, 0.0, 1.0]
    projection = [info.fx, 0.0, info.cx, 0.0, 0.0, info.fy, info.cy, 0.0, 0.0, 0.0, 1.0, 0.0]
    distortion = list(info.distortion)
    return fox.CameraCalibration(
        timestamp=_timestamp(info.time_ns),
        frame_id=camera,
        width=info.width,
        height=info.height,
        distortion_model="plumb_bob" if len(distortion) <= 5 else "rational_polynomial",
        D=distortion,
        K=lens,
        R=[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        P=projection,
    )


def _object(one: Recorded, message: ObjectPose) -> Iterator[Published]:
    """Yield where an object is; nothing where it is lost."""
    pose = message.camera_from_object
    if pose is None:
        return
    suffix = LABEL_SUFFIX if one.topic.startswith(f"{LABEL.stream}/") else ""
    child = message.object + suffix
    yield "/tf", _transforms(message.time_ns, message.camera, child, pose)
    placed = fox.Pose(position=_vector(pose), orientation=_quaternion(pose))
    stamp = _timestamp(message.time_ns)
    yield f"/{one.topic}", fox.PoseInFrame(timestamp=stamp, frame_id=message.camera, pose=placed)


def _transforms(time_ns: int, parent: str, child: str, pose: Pose) -> fox.FrameTransforms:
    transform = fox.FrameTransform(
        timestamp=_timestamp(time_ns),
        parent_frame_id=parent,
        child_frame_id=child,
        translation=_vector(pose),
        rotation=_quaternion(pose),
    )
    return fox.FrameTransforms(transforms=[transform])


def _people(camera: str, message: Skeletons) -> fox.SceneUpdate:
    entities = [
        fox.SceneEntity(
            timestamp=_timestamp(message.time_ns),
            frame_id=camera,
            id=f"person {person.id}",
            lifetime=fox.Duration(0, round(1e9 * STYLE.shown_s)),
            frame_locked=True,
            spheres=_joints(person),
            lines=[_bones(person)],
        )
        for person in message.people
    ]
    return fox.SceneUpdate(entities=entities)


def _joints(person: Person) -> list[fox.SpherePrimitive]:
    size = fox.Vector3(x=STYLE.joint_m, y=STYLE.joint_m, z=STYLE.joint_m)
    return [
        fox.SpherePrimitive(pose=_point_pose(joint), size=size, color=_COLOUR)
        for joint, state in zip(person.joints, person.states, strict=True)
        if state != "missing"
    ]


def _bones(person: Person) -> fox.LinePrimitive:
    seen = [state != "missing" for state in person.states]
    ends = [
        end
        for joint, parent in enumerate(PARENTS)
        if parent >= 0 and seen[joint] and seen[parent]
        for end in (person.joints[parent], person.joints[joint])
    ]
    return fox.LinePrimitive(
        type=fox.LinePrimitiveLineType.LineList,
        pose=_point_pose((0.0, 0.0, 0.0)),
        thickness=STYLE.bone_m,
        points=[fox.Point3(x=x, y=y, z=z) for x, y, z in ends],
        color=_COLOUR,
    )


def _point_pose(place: tuple[float, float, float]) -> fox.Pose:
    x, y, z = place
    upright = fox.Quaternion(x=0.0, y=0.0, z=0.0, w=1.0)
    return fox.Pose(position=fox.Vector3(x=x, y=y, z=z), orientation=upright)


def _vector(pose: Pose) -> fox.Vector3:
    x, y, z = pose.translation
    return fox.Vector3(x=x, y=y, z=z)


def _quaternion(pose: Pose) -> fox.Quaternion:
    w, x, y, z = pose.rotation
    return fox.Quaternion(x=x, y=y, z=z, w=w)


def _timestamp(time_ns: int) -> fox.Timestamp:
    return fox.Timestamp(time_ns // 1_000_000_000, time_ns % 1_000_000_000)
