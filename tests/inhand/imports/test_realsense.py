"""Bags as RealSense's SDK writes them become recordings, with depth aligned to colour.

The bags are written by the layout of librealsense 2.56: its topics, its image message, which has
four bytes more than its definition says, and times in the bag that begin at 0.
"""

import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import inhand_recorder
import numpy as np
import pytest
from inhand_recorder.verification import verify_recording
from inhand_runtime.recording import read_metadata
from rosbags.rosbag1 import Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from inhand.__main__ import main

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


def bring(source: Path, output: Path, *more: str) -> int:
    return main(["recording", "import", str(source), "--from", "ros", "-o", str(output), *more])


@pytest.mark.parametrize("units", [UNITS_M, 0.0], ids=["units in images", "units of an option"])
def test_depth_is_what_the_colour_camera_would_measure(
    units: float, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "out.mcap"
    bag = write_bag(tmp_path / "a.bag", units=units, shift=(-0.05, 0.0, 0.0))
    assert bring(bag, output, "--camera", "front") == 0
    said = capsys.readouterr().out
    assert f"{output}: 1 info/front, 3 rgbd/front\n" in said
    assert "depth is aligned to colour" in said
    assert "own clock" not in said
    assert verify_recording(output) == []
    about = read_metadata(output)["import"]
    assert (about["device"], about["aligned"]) == ("Intel RealSense D435", "true")
    assert (about["depth"], about["colour"]) == (f"{DEPTH}/image/data", f"{COLOUR}/image/data")
    # 5 cm to the right, at 60 pixels a radian: the wall moves by 3 pixels, the board by 6.
    true = np.zeros((SIZE, SIZE), int)
    true[:, :45] = round(1.0 / UNITS_M)
    true[20:30, 20:30] = round(0.5 / UNITS_M)
    true[20:30, 30:33] = 0  # seen by the colour camera alone
    with inhand_recorder.open(output) as recording:
        assert recording.infos["front"].depth_scale == pytest.approx(UNITS_M)
        frames = list(recording["rgbd/front"])
        for number, frame in enumerate(frames):
            assert frame.time_ns == START_NS + number * FRAME_NS + 4_000_000
            assert frame.received_ns == frame.time_ns
            assert frame.message.time_uncertainty_ns == 4_000_000
            np.testing.assert_array_equal(frame.depth, true)
            np.testing.assert_allclose(frame.colour[20, 20], (200, 20, 10), atol=3)


def test_a_turned_colour_camera_sees_depth_turned(tmp_path: Path) -> None:
    bag = write_bag(tmp_path / "a.bag", turn=TURN, shift=(0.0, 0.0, 0.1))
    assert bring(bag, tmp_path / "out.mcap") == 0
    with inhand_recorder.open(tmp_path / "out.mcap") as recording:
        (frame, *_) = recording["rgbd/camera"]
        # x goes to y and y to -x, so a pixel (u, v) to (47 - v, u), and all is 10 cm farther away.
        turned = np.rot90(depth_image(), -1)
        board = np.argwhere(turned < 1500).mean(axis=0) - CENTRE
        seen = np.argwhere((frame.depth > 0) & (frame.depth < 1500)).mean(axis=0) - CENTRE
        np.testing.assert_allclose(seen, board * 0.5 / 0.6, atol=0.5)
        assert frame.depth[24, 40] == round(1.1 / UNITS_M)
        assert np.median(frame.depth_m[frame.depth_m < 0.8][1:]) in (0.0, pytest.approx(0.6))


def test_colour_in_yuv_is_read_and_times_of_the_cameras_own_clock_are_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bag = write_bag(tmp_path / "a.bag", encoding="yuv422", start_ns=50_000_000_000)
    assert bring(bag, tmp_path / "out.mcap") == 0
    assert "times are of the camera's own clock" in capsys.readouterr().out
    with inhand_recorder.open(tmp_path / "out.mcap") as recording:
        (frame, *_) = recording["rgbd/camera"]
        # BT.601: Y of 90 with neutral U and V is grey, 1.164 × (90 − 16).
        np.testing.assert_allclose(frame.colour[20, 20], 86, atol=2)


def no_place(bag: Bag) -> None:
    other = f"{DEVICE}/sensor_2/Depth_0"
    bag.stream(other, "mono16", "Brown Conrady", (0.0,) * 5)
    bag.image(other, START_NS, depth_image(), "mono16", UNITS_M)


def cut(bag: Bag) -> None:
    """Put an image whose message is shorter than it says."""
    short = depth_image()[:10]
    bag.image(DEPTH, START_NS + 4 * FRAME_NS, short, "mono16", UNITS_M)
    colour = np.zeros((SIZE, SIZE, 3), np.uint8)
    bag.image(COLOUR, START_NS + 4 * FRAME_NS, colour, "rgb8", UNITS_M)


def test_what_is_missing_or_not_read_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "out.mcap"
    odd = write_bag(tmp_path / "odd.bag", model="Kannala Brandt4", coefficients=(0.1,) * 5)
    two = write_bag(tmp_path / "two.bag", spoil=no_place)
    more = ("--depth", f"{DEVICE}/sensor_2/Depth_0/image/data")
    for bag, options, said in (
        (odd, (), "a lens of the model 'Kannala Brandt4' is not read"),
        (two, (), "choose one with --depth: /device_0/sensor_0/Depth_0/image/data"),
        (two, more, "there is no /device_0/sensor_2/Depth_0/tf/0"),
    ):
        assert bring(bag, output, *options) == 1
        assert said in capsys.readouterr().err
        assert not output.exists()
    assert bring(write_bag(tmp_path / "cut.bag", spoil=cut), output) == 0
    said = capsys.readouterr().out
    assert "4 rgbd/camera" in said
    assert "1 image left out; the first: /device_0/sensor_0/Depth_0/image/data: " in said
