"""Recordings of RealSense's SDK and viewer, which have topics and times of their own.

Up to release 2.57 these are bags of ROS 1 (``.bag``), of later ones bags of ROS 2 (``.db3``), of
which 2.58 compresses each message by itself. A stream has its images on
``/device_0/sensor_0/Depth_0/image/data``, with ``/compressedDepth`` or ``/compressed`` after it
where they are so. Beside it stand its lens, how points get to it from the device's reference
stream, and the settings of its sensor: as messages of ROS in the former, and as texts
(``width=640;height=480``) in the latter. There the header's time counts from the begin of the
recording, and the image's own time stands in the text of its ``image/metadata``.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation

import msgspec
import numpy as np
from inhand_runtime.errors import InhandError
from inhand_schemas.messages import CameraInfo
from inhand_tracker.geometry.rotations import to_matrix
from numpy.typing import NDArray
from rosbags.highlevel import AnyReader
from rosbags.interfaces import Connection

from inhand.imports.alignment import DepthAlignment, align_depth
from inhand.imports.ros_bag import first_message, messages_on, read_message, standard_image
from inhand.imports.ros_images import info_of

_IMAGES = re.compile(
    r"((/device_\d+/sensor_\d+)/(\w+)_\d+)/image/data(?:/compressed|/compressedDepth)?"
)
_KNOWN_LENSES = ("None", "Brown Conrady", "Modified Brown Conrady", "Inverse Brown Conrady")
"""Models of distortion that librealsense projects as OpenCV does, by its names."""

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class RealSenseStream:
    """A stream of images: its topic, what its topics and those of its sensor begin with, and what
    it is, ``Depth`` or ``Color``."""

    topic: str
    prefix: str
    sensor: str
    kind: str


def realsense_streams(connections: Sequence[Connection]) -> list[RealSenseStream]:
    """Return the streams of images of a bag; none where it is no RealSense's."""
    topics = sorted({one.topic for one in connections})
    found = [(topic, _IMAGES.fullmatch(topic)) for topic in topics]
    return [RealSenseStream(topic, *match.groups()) for topic, match in found if match]


def lens_topic(reader: AnyReader, stream: RealSenseStream) -> str:
    """Return the topic that has a stream's lens, a CameraInfo in ROS 1 and a text in ROS 2."""
    return f"{stream.prefix}/{'camera_info' if reader.is2 else 'info/camera_info'}"


def lens_of(
    reader: AnyReader, stream: RealSenseStream, time_ns: int, frame_rate: float
) -> CameraInfo:
    """Return a stream's lens; raises InhandError where it is missing, or not as OpenCV has it."""
    topic = lens_topic(reader, stream)
    message = first_message(reader, topic)
    if message is None:
        raise InhandError(f"{topic} has no message")
    if reader.is2:
        model, info = _lens_of_text(topic, message.data, time_ns, frame_rate)
    else:
        model, info = message.distortion_model, info_of(message, time_ns, frame_rate)
    if model not in _KNOWN_LENSES and any(info.distortion):
        raise InhandError(f"a lens of the model {model!r} is not read, only {_KNOWN_LENSES}")
    return info


def _lens_of_text(topic: str, text: str, time_ns: int, frame_rate: float) -> tuple[str, CameraInfo]:
    entries = _entries(text)
    names = ("width", "height", "fx", "fy", "ppx", "ppy")
    found = ",".join(entries.get(name, "") for name in names)
    width, height, fx, fy, cx, cy = _numbers(topic, found, len(names)).tolist()
    distortion = _numbers(topic, entries.get("coeffs", ""), 5).tolist()
    try:
        return entries.get("model", ""), CameraInfo(
            sequence=0,
            time_ns=time_ns,
            width=int(width),
            height=int(height),
            fx=fx,
            fy=fy,
            cx=cx,
            cy=cy,
            distortion=tuple(distortion),
            frame_rate=frame_rate,
        )
    except ValueError as error:
        raise InhandError(f"{topic}: {error}") from None


def capture_times(reader: AnyReader, stream: RealSenseStream) -> dict[int, int]:
    """Return when images were taken by their times in the bag, both in nanoseconds.

    Empty where the images' headers say it, as in bags of ROS 1.
    """
    times: dict[int, int] = {}
    if not reader.is2:
        return times
    for connection, bag_ns, raw in messages_on(reader, f"{stream.prefix}/image/metadata"):
        entries = _entries(read_message(reader, connection, raw).data)
        try:
            times[bag_ns] = int(Decimal(entries.get("timestamp", "")).scaleb(6))
        except (InvalidOperation, ValueError, OverflowError):
            continue
    return times


def depth_units(reader: AnyReader, depth: RealSenseStream) -> float:
    """Return the metres of a unit of depth; raises InhandError where the bag does not say them."""
    topic = f"{depth.sensor}/option/Depth_Units/value"
    if not reader.is2:
        for _, _, raw in messages_on(reader, depth.topic):
            if (units := standard_image(raw)[1]) > 0.0:
                return units
            break
    option = first_message(reader, topic)
    if option is None:
        raise InhandError(f"there is no {topic}: how long the units of depth are, is not said")
    try:
        return float(option.data)
    except ValueError:
        raise InhandError(f"{topic}: {option.data!r} is no number") from None


def device_name(reader: AnyReader, stream: RealSenseStream) -> str:
    """Return the model of the camera, ``Intel RealSense D435``, or else ``RealSense``."""
    topic = f"/{stream.topic.split('/')[1]}/info"
    if reader.is2:
        return _text(reader, topic).get("Name", "RealSense")
    for connection, _, raw in messages_on(reader, topic):
        entry = read_message(reader, connection, raw)
        if entry.key == "Name":
            return str(entry.value)
    return "RealSense"


def alignment_of(
    reader: AnyReader,
    depth: tuple[RealSenseStream, CameraInfo],
    colour: tuple[RealSenseStream, CameraInfo],
    units: float,
) -> DepthAlignment:
    """Prepare to align depth to colour; raises InhandError where their places are not said."""
    (of_depth, depth_info), (of_colour, colour_info) = depth, colour
    depth_group, depth_rotation, depth_place = _from_reference(reader, of_depth)
    group, rotation, place = _from_reference(reader, of_colour)
    if group != depth_group:
        raise InhandError("it does not say where its colour camera is from its depth camera")
    turn = rotation @ depth_rotation.T
    scaled = msgspec.structs.replace(depth_info, depth_scale=units)
    return align_depth(scaled, colour_info, turn, place - turn @ depth_place)


def _from_reference(reader: AnyReader, stream: RealSenseStream) -> tuple[str, Floats, Floats]:
    """Return which reference it is, and the rotation (3, 3) and translation (3,) from there."""
    topics = {one.topic for one in reader.connections}
    found = sorted(topic for topic in topics if topic.startswith(f"{stream.prefix}/tf/"))
    transform = first_message(reader, found[0]) if found else None
    if transform is None:
        raise InhandError(
            f"there is no {stream.prefix}/tf/0: where the colour camera is from the depth camera, "
            "is not said"
        )
    group = found[0].rpartition("/")[2]
    if reader.is2:
        entries = _entries(transform.data)
        # Column by column, as all matrices of librealsense.
        turned = _numbers(found[0], entries.get("rotation", ""), 9).reshape(3, 3).T
        return group, turned, _numbers(found[0], entries.get("translation", ""), 3)
    turn, shift = transform.rotation, transform.translation
    rotation = to_matrix(np.array([turn.w, turn.x, turn.y, turn.z]))
    return group, rotation, np.array([shift.x, shift.y, shift.z])


def _text(reader: AnyReader, topic: str) -> Mapping[str, str]:
    """Return the entries of a topic's first text; empty without any."""
    message = first_message(reader, topic)
    return {} if message is None else _entries(message.data)


def _entries(text: str) -> dict[str, str]:
    """Return ``name=value`` of a text that has them between semicolons."""
    pairs = (part.partition("=") for part in str(text).split(";"))
    return {name: value for name, sign, value in pairs if sign}


def _numbers(topic: str, text: str, count: int) -> Floats:
    try:
        numbers = np.array([float(one) for one in text.split(",")])
    except ValueError:
        numbers = np.zeros(0)
    if len(numbers) != count or not np.isfinite(numbers).all():
        raise InhandError(f"{topic}: {text!r} is not {count} numbers")
    return numbers
