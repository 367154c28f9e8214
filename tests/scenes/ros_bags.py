"""Bags of ROS 1 and 2 with a camera's messages, written by ``rosbags``."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.rosbag1 import Writer as BagWriter
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as FolderWriter
from rosbags.typesys import Stores, get_typestore
from small_rig import HEIGHT, WIDTH

ROS1, ROS2 = get_typestore(Stores.ROS1_NOETIC), get_typestore(Stores.ROS2_HUMBLE)
Put = Callable[[str, str, int, Any], None]


class Ros:
    """Messages of one ROS, which differ in their headers and in the case of a lens's fields."""

    def __init__(self, store: Any, *, second: bool) -> None:
        self._types, self._second = store.types, second

    def of(self, name: str, **fields: Any) -> Any:
        return self._types[f"sensor_msgs/msg/{name}"](**fields)

    def header(self, time_ns: int) -> Any:
        stamp = self._types["builtin_interfaces/msg/Time"](
            sec=time_ns // 1_000_000_000, nanosec=time_ns % 1_000_000_000
        )
        number = {} if self._second else {"seq": 0}
        return self._types["std_msgs/msg/Header"](stamp=stamp, frame_id="optical", **number)

    def image(self, time_ns: int, pixels: np.ndarray, encoding: str) -> Any:
        return self.of(
            "Image",
            header=self.header(time_ns),
            height=HEIGHT,
            width=WIDTH,
            encoding=encoding,
            is_bigendian=int(pixels.dtype.byteorder == ">"),
            step=pixels.strides[0],
            data=np.frombuffer(pixels.tobytes(), np.uint8),
        )

    def jpeg(self, time_ns: int, data: bytes) -> Any:
        kind = "rgb8; jpeg compressed bgr8"
        header, data = self.header(time_ns), np.frombuffer(data, np.uint8)
        return self.of("CompressedImage", header=header, format=kind, data=data)

    def lens(self, time_ns: int) -> Any:
        numbers = {
            "D": np.array([0.1, -0.05, 0.0, 0.0, 0.01]),
            "K": np.array([60.0, 0.0, 31.5, 0.0, 61.0, 23.5, 0.0, 0.0, 1.0]),
            "R": np.eye(3).ravel(),
            "P": np.eye(3, 4).ravel(),
        }
        if self._second:
            numbers = {name.lower(): values for name, values in numbers.items()}
        roi = {"x_offset": 0, "y_offset": 0, "height": 0, "width": 0, "do_rectify": False}
        return self.of(
            "CameraInfo",
            header=self.header(time_ns),
            height=HEIGHT,
            width=WIDTH,
            distortion_model="plumb_bob",
            binning_x=0,
            binning_y=0,
            roi=self.of("RegionOfInterest", **roi),
            **numbers,
        )


@contextmanager
def bag(path: Path, kind: str) -> Iterator[tuple[Ros, Put]]:
    """Write a bag as rosbags does; messages are put by topic, type, time of reception."""
    second = kind != "ros1"
    store = ROS2 if second else ROS1
    plugin = StoragePlugin.MCAP if kind == "mcap" else StoragePlugin.SQLITE3
    writer = FolderWriter(path, version=9, storage_plugin=plugin) if second else BagWriter(path)
    connections: dict[str, Any] = {}
    with writer:

        def put(topic: str, name: str, received_ns: int, message: Any) -> None:
            kind = f"sensor_msgs/msg/{name}"
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=store)
            code = store.serialize_cdr if second else store.serialize_ros1
            writer.write(connections[topic], received_ns, code(message, kind))

        yield Ros(store, second=second), put
