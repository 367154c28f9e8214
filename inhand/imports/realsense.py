"""Bags of RealSense's SDK and viewer: bags of ROS 1 with topics and an image message of their own.

As `ros_file_format.h` and `ros_writer.cpp` of librealsense 2 write them: a stream has its images on
``/device_0/sensor_0/Depth_0/image/data``, its lens on ``…/info/camera_info``, and on ``…/tf/0`` how
points get to it from the device's reference stream; a sensor's settings are on
``/device_0/sensor_0/option/Depth_Units/value``. Images have four bytes more than ROS defines, the
length of a unit of depth. The times of messages in the bag count from the begin of the recording.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass

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

_IMAGES = re.compile(r"(/device_\d+/sensor_\d+)/(\w+)_\d+/image/data")
_KNOWN_LENSES = ("None", "Brown Conrady", "Modified Brown Conrady", "Inverse Brown Conrady")
"""Models of distortion that librealsense projects as OpenCV does, by its names."""


@dataclass(frozen=True)
class RealSenseStream:
    """A stream of images: its topic, that of its sensor, and what it is, ``Depth`` or ``Color``."""

    topic: str
    sensor: str
    kind: str

    @property
    def prefix(self) -> str:
        """What its topics begin with."""
        return self.topic.removesuffix("/image/data")


def realsense_streams(connections: Sequence[Connection]) -> list[RealSenseStream]:
    """Return the streams of images of a bag; none where it is no RealSense's."""
    topics = sorted({one.topic for one in connections})
    found = [(topic, _IMAGES.fullmatch(topic)) for topic in topics]
    return [RealSenseStream(topic, match[1], match[2]) for topic, match in found if match]


def depth_units(reader: AnyReader, depth: RealSenseStream) -> float:
    """Return the metres of a unit of depth; raises InhandError where the bag does not say them."""
    for _, _, raw in messages_on(reader, depth.topic):
        if (units := standard_image(raw)[1]) > 0.0:
            return units
        break
    option = first_message(reader, f"{depth.sensor}/option/Depth_Units/value")
    if option is None:
        raise InhandError(f"{depth.topic} does not say how long its units are")
    return float(option.data)


def device_name(reader: AnyReader, stream: RealSenseStream) -> str:
    """Return the model of the camera, ``Intel RealSense D435``, or else ``RealSense``."""
    for connection, _, raw in messages_on(reader, f"/{stream.topic.split('/')[1]}/info"):
        entry = read_message(reader, connection, raw)
        if entry.key == "Name":
            return str(entry.value)
    return "RealSense"


def check_lens(model: str, info: CameraInfo) -> None:
    """Raise InhandError for a distortion that is not as OpenCV has it."""
    if model not in _KNOWN_LENSES and any(info.distortion):
        raise InhandError(f"a lens of the model {model!r} is not read, only {_KNOWN_LENSES}")


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


def _from_reference(
    reader: AnyReader, stream: RealSenseStream
) -> tuple[str, NDArray[np.float64], NDArray[np.float64]]:
    """Return which reference it is, and the rotation (3, 3) and translation (3,) from there."""
    topics = {one.topic for one in reader.connections}
    found = sorted(topic for topic in topics if topic.startswith(f"{stream.prefix}/tf/"))
    transform = first_message(reader, found[0]) if found else None
    if transform is None:
        raise InhandError(
            f"there is no {stream.prefix}/tf/0: where the colour camera is from the depth camera, "
            "is not said"
        )
    turn, shift = transform.rotation, transform.translation
    rotation = to_matrix(np.array([turn.w, turn.x, turn.y, turn.z]))
    return found[0].rpartition("/")[2], rotation, np.array([shift.x, shift.y, shift.z])
