"""Bags of a RealSense, as librealsense 2.56 and 2.59 write them, by what they wrote.

The former are of ROS 1: its topics, its image message, which has four bytes more than its
definition says, and times in the bag that begin at 0. The latter are of ROS 2: compressed images
with such times in their headers, and texts for all else.
"""

import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import zstandard
from rosbags.rosbag1 import Writer
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as FolderWriter
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

STORE = get_typestore(Stores.ROS1_NOETIC)
STORE.register(
    get_types_from_msg(
        "uint32 fps\nstring encoding\nbool is_recommended\n", "realsense_msgs/msg/StreamInfo"
    )
)
DEVICE = "/device_0"
DEPTH, COLOUR = f"{DEVICE}/sensor_0/Depth_0", f"{DEVICE}/sensor_1/Color_0"
SIZE = 48
CENTRE = (SIZE - 1) / 2.0
UNITS_M = 0.0005
START_NS, FRAME_NS = 1_700_000_000_123_000_000, 33_000_000
FIRST = 1
"""Time in the bag of what was written before the stream, nanoseconds."""
AHEAD = (0.0, 0.0, 0.0, 1.0)
TURN = (0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5))
"""A quarter turn about the optical axis, x y z w: x to y."""


def message(name: str, **fields: Any) -> Any:
    package, _, kind = name.partition("/")
    return STORE.types[f"{package}/msg/{kind}"](**fields)


def header(time_ns: int, version: str) -> Any:
    seconds, rest = divmod(time_ns, 1_000_000_000)
    stamp = message("builtin_interfaces/Time", sec=seconds, nanosec=rest)
    return message("std_msgs/Header", seq=0, stamp=stamp, frame_id=version)


class Bag:
    """Writes what librealsense would."""

    def __init__(self, writer: Writer) -> None:
        self._writer, self._connections = writer, {}

    def put(self, topic: str, name: str, bag_ns: int, fields: Any, more: bytes = b"") -> None:
        kind = name.replace("/", "/msg/")
        if topic not in self._connections:
            connection = self._writer.add_connection(topic, kind, typestore=STORE)
            self._connections[topic] = connection
        raw = bytes(STORE.serialize_ros1(fields, kind)) + more
        self._writer.write(self._connections[topic], bag_ns, raw)

    def say(self, topic: str, key: str, value: str, bag_ns: int = FIRST) -> None:
        entry = message("diagnostic_msgs/KeyValue", key=key, value=value)
        self.put(topic, "diagnostic_msgs/KeyValue", bag_ns, entry)

    def option(self, sensor: str, name: str, value: float) -> None:
        topic = f"{DEVICE}/{sensor}/option/{name}/value"
        self.put(topic, "std_msgs/Float32", FIRST, message("std_msgs/Float32", data=value))

    def stream(self, prefix: str, encoding: str, model: str, coefficients: Any) -> None:
        info = message("realsense_msgs/StreamInfo", fps=30, encoding=encoding, is_recommended=True)
        self.put(f"{prefix}/info", "realsense_msgs/StreamInfo", FIRST, info)
        roi = {"x_offset": 0, "y_offset": 0, "height": 0, "width": 0, "do_rectify": False}
        lens = message(
            "sensor_msgs/CameraInfo",
            header=header(0, ""),
            height=SIZE,
            width=SIZE,
            distortion_model=model,
            D=np.array(coefficients),
            K=np.array([60.0, 0.0, CENTRE, 0.0, 60.0, CENTRE, 0.0, 0.0, 1.0]),
            R=np.zeros(9),
            P=np.zeros(12),
            binning_x=0,
            binning_y=0,
            roi=message("sensor_msgs/RegionOfInterest", **roi),
        )
        self.put(f"{prefix}/info/camera_info", "sensor_msgs/CameraInfo", FIRST, lens)

    def place(self, prefix: str, shift: tuple[float, ...], turn: tuple[float, ...]) -> None:
        vector = message("geometry_msgs/Vector3", **dict(zip("xyz", shift, strict=True)))
        rotation = message("geometry_msgs/Quaternion", **dict(zip("xyzw", turn, strict=True)))
        transform = message("geometry_msgs/Transform", translation=vector, rotation=rotation)
        self.put(f"{prefix}/tf/0", "geometry_msgs/Transform", FIRST, transform)

    def image(self, prefix: str, time_ns: int, pixels: Any, encoding: str, units: float) -> None:
        """Put an image; without units as releases before that wrote them."""
        image = message(
            "sensor_msgs/Image",
            header=header(time_ns, "1" if units else ""),
            height=SIZE,
            width=SIZE,
            encoding=encoding,
            is_bigendian=0,
            step=pixels.strides[0],
            data=np.frombuffer(pixels.tobytes(), np.uint8),
        )
        more = struct.pack("<f", units if encoding == "mono16" else 0.0) if units else b""
        bag_ns = time_ns % START_NS + 5_000_000
        self.put(f"{prefix}/image/data", "sensor_msgs/Image", bag_ns, image, more)
        self.say(f"{prefix}/image/metadata", "timestamp_domain", "Global Time", bag_ns)


def depth_image() -> np.ndarray:
    """A wall a metre away, and before it, at half of that, a board of 10 × 10 pixels."""
    depth = np.full((SIZE, SIZE), round(1.0 / UNITS_M), np.uint16)
    depth[20:30, 26:36] = round(0.5 / UNITS_M)
    return depth


def write_bag(
    path: Path,
    *,
    turn: tuple[float, ...] = AHEAD,
    shift: tuple[float, ...] = (-0.05, 0.0, 0.0),
    units: float = UNITS_M,
    model: str = "Inverse Brown Conrady",
    coefficients: tuple[float, ...] = (0.0,) * 5,
    encoding: str = "rgb8",
    spoil: Callable[[Bag], None] = lambda bag: None,
    start_ns: int = START_NS,
) -> Path:
    """Write three frames; ``turn`` and ``shift`` are from the depth to the colour camera."""
    writer = Writer(path)
    writer.set_compression(Writer.CompressionFormat.LZ4)
    with writer:
        bag = Bag(writer)
        bag.put("/file_version", "std_msgs/UInt32", FIRST, message("std_msgs/UInt32", data=4))
        bag.say(f"{DEVICE}/info", "Name", "Intel RealSense D435")
        bag.say(f"{DEVICE}/info", "Serial Number", "012345678901")
        bag.say(f"{DEVICE}/sensor_0/info", "Name", "Stereo Module")
        bag.option("sensor_0", "Depth_Units", UNITS_M)
        bag.option("sensor_0", "Exposure", 8500.0)
        bag.stream(DEPTH, "mono16", "Brown Conrady", (0.0,) * 5)
        bag.stream(COLOUR, encoding, model, coefficients)
        infrared = f"{DEVICE}/sensor_0/Infrared_1"
        bag.stream(infrared, "16UC1", "Brown Conrady", (0.0,) * 5)
        bag.place(DEPTH, (0.0, 0.0, 0.0), AHEAD)
        bag.place(COLOUR, shift, turn)
        for number in range(3):
            time_ns = start_ns + number * FRAME_NS
            grey = np.full((SIZE, SIZE), 300, np.uint16)
            bag.image(infrared, time_ns, grey, "16UC1", units)
            bag.image(DEPTH, time_ns, depth_image(), "mono16", units)
            colour = np.full((SIZE, SIZE, 3), (200, 20, 10), np.uint8)
            if encoding == "yuv422":  # U and Y, V and Y
                colour = np.full((SIZE, SIZE, 2), (128, 90), np.uint8)
            bag.image(COLOUR, time_ns + 4_000_000, colour, encoding, units)
        spoil(bag)
    return path


def write_db3(
    folder: Path,
    *,
    model: str = "Inverse Brown Conrady",
    first_coefficient: float = 0.0,
    one_by_one: bool = False,
) -> Path:
    """Write three frames as release 2.59 does, the colour camera 5 cm beside the depth camera.

    The second image of depth lacks its metadata. With ``one_by_one`` each message is compressed by
    itself, as by 2.58.
    """
    store = get_typestore(Stores.ROS2_HUMBLE)
    connections: dict[str, Any] = {}

    def of(name: str, **fields: Any) -> Any:
        package, _, kind = name.partition("/")
        return store.types[f"{package}/msg/{kind}"](**fields)

    with FolderWriter(folder, version=9, storage_plugin=StoragePlugin.SQLITE3) as writer:

        def put(topic: str, name: str, bag_ns: int, fields: Any) -> None:
            kind = name.replace("/", "/msg/")
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=store)
            raw = bytes(store.serialize_cdr(fields, kind))
            data = zstandard.ZstdCompressor().compress(raw) if one_by_one else raw
            writer.write(connections[topic], bag_ns, data)

        def say(topic: str, text: str, bag_ns: int = 0) -> None:
            put(topic, "std_msgs/String", bag_ns, of("std_msgs/String", data=text))

        def stamped(bag_ns: int, frame: str) -> Any:
            stamp = of("builtin_interfaces/Time", sec=0, nanosec=bag_ns)
            return of("std_msgs/Header", stamp=stamp, frame_id=frame)

        def image(prefix: str, bag_ns: int, time_ns: int, pixels: Any, *, whole: bool) -> None:
            deep = prefix == DEPTH
            data = (bytes(12) if deep else b"") + cv2.imencode(".png", pixels)[1].tobytes()
            compressed = of(
                "sensor_msgs/CompressedImage",
                header=stamped(bag_ns, "Depth" if deep else "Color"),
                format="16UC1; compressedDepth png" if deep else "rgb8; png compressed bgr8",
                data=np.frombuffer(data, np.uint8),
            )
            suffix = "compressedDepth" if deep else "compressed"
            put(f"{prefix}/image/data/{suffix}", "sensor_msgs/CompressedImage", bag_ns, compressed)
            if whole:
                text = f"Frame number=1;timestamp_domain=Global Time;timestamp={time_ns / 1e6:.6f};"
                say(f"{prefix}/image/metadata", text, bag_ns)

        say(f"{DEVICE}/info", "Name=Intel RealSense D455;Serial Number=012345678901")
        say(f"{DEVICE}/sensor_0/option/Depth_Units/value", f"{UNITS_M:.6f}")
        lens = f"width={SIZE};height={SIZE};fx=60;ppx={CENTRE};fy=60;ppy={CENTRE};model="
        say(f"{COLOUR}/camera_info", f"{lens}{model};coeffs={first_coefficient},0,0,0,0")
        say(f"{DEPTH}/camera_info", f"{lens}Brown Conrady;coeffs=0,0,0,0,0")
        # The reference stream is turned: x to y, column by column.
        turned = "rotation=0.0,1.0,0.0,-1.0,0.0,0.0,0.0,0.0,1.0;translation="
        say(f"{DEPTH}/tf/ref_1", f"{turned}0.100000,0.000000,0.000000")
        say(f"{COLOUR}/tf/ref_1", f"{turned}0.050000,0.000000,0.000000")
        for number in range(3):
            bag_ns = 500 + number * FRAME_NS
            time_ns = START_NS + number * FRAME_NS
            colour = np.full((SIZE, SIZE, 3), (10, 20, 200), np.uint8)
            image(DEPTH, bag_ns, time_ns, depth_image(), whole=number != 1)
            image(COLOUR, bag_ns + 700_000, time_ns + 4_000_000, colour, whole=True)
    return next(folder.glob("*.db3"))
