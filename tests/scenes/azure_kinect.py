"""Recordings of an Azure Kinect, written byte by byte as its SDK's recorder lays them out.

As ``k4arecord`` 1.4 does (``record.cpp`` and ``matroska_write.cpp`` of the Azure Kinect Sensor
SDK): Matroska with time codes in microseconds, tracks COLOR, DEPTH, IR and IMU, 16 bits big-endian
as ``b16g``, the calibration as the attachment ``calibration.json``, settings as tags.
"""

import json
import struct
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import simplejpeg

FRAME_US, LATE_US = 33_333, 160
COLOUR, DEPTH, IR = 1, 2, 3
WIDE, NARROW = (1280, 720), (320, 288)
WALL_M, BOARD_M = 1.0, 0.6
BOARD = slice(110, 170), slice(130, 190)
SINCE_2001_NS = 978_307_200_000_000_000
"""Nanoseconds from 1970 to the year that Matroska counts from."""
EBML, SEGMENT, INFO, TRACKS = 0x1A45DFA3, 0x18538067, 0x1549A966, 0x1654AE6B
ATTACHMENTS, TAGS, CLUSTER, VOID = 0x1941A469, 0x1254C367, 0x1F43B675, 0xEC
FOURCC = "V_MS/VFW/FOURCC"
DEPTH_LENS = (0.502, 0.501, 0.4928, 0.4929, 0.58, 0.006, -0.0013, 0.92, 0.125, -0.0065)
COLOUR_LENS = (0.498, 0.503, 0.48, 0.64, -1.06, -1.4, 1.75, -1.15, -1.19, 1.62)
"""Centre and focal lengths as shares of the sensor's width and height, then k1 to k6."""
TANGENTIAL = (0.0, 0.0, -0.00002, -0.00012)
"""Centre of distortion, then p2 and p1."""
TURN = (1.0, 0.0, 0.0, 0.0, 0.9976, 0.0692, 0.0, -0.0692, 0.9976)
SHIFT_M = (-0.032, -0.002, 0.004)


def element(identity: int, content: bytes | int | str) -> bytes:
    """An element of EBML with its size; a number is big-endian without leading zeros."""
    if isinstance(content, int):
        content = content.to_bytes(max(1, (content.bit_length() + 7) // 8), "big")
    if isinstance(content, str):
        content = content.encode()
    head = identity.to_bytes((identity.bit_length() + 7) // 8, "big")
    return head + (len(content) | 1 << 56).to_bytes(8, "big") + content


def parent(identity: int, *children: bytes) -> bytes:
    return element(identity, b"".join(children))


def track(number: int, name: str, size: tuple[int, int], fourcc: bytes, bits: int) -> bytes:
    width, height = size
    header = struct.pack(
        "<IIIHH4sIIIII", 40, width, height, 1, bits, fourcc, width * height * bits // 8, 0, 0, 0, 0
    )
    return parent(
        0xAE,
        element(0xD7, number),
        element(0x73C5, 1000 + number),
        element(0x83, 1),
        element(0x536E, name),
        element(0x86, FOURCC),
        element(0x9C, 1),
        element(0x63A2, header),
        element(0x23E383, 33_333_333),
        parent(0xE0, element(0xB0, width), element(0xBA, height)),
    )


def tag(name: str, value: str, track_number: int | None = None) -> bytes:
    targets = parent(0x63C0, element(0x63C5, 0))
    if track_number is not None:
        targets = parent(0x63C0, element(0x63CA, "TRACK"), element(0x63C5, 1000 + track_number))
    return parent(0x7373, targets, parent(0x67C8, element(0x45A3, name), element(0x4487, value)))


def camera_json(purpose: str, lens: tuple[float, ...], size: tuple[int, int], **more: Any) -> Any:
    return {
        "Intrinsics": {
            "ModelParameterCount": 14,
            "ModelParameters": [*lens, *TANGENTIAL],
            "ModelType": "CALIBRATION_LensDistortionModelBrownConrady",
        },
        "Location": f"CALIBRATION_CameraLocation{purpose}",
        "MetricRadius": 1.7,
        "Rt": {
            "Rotation": TURN if purpose == "PV0" else np.eye(3).ravel().tolist(),
            "Translation": SHIFT_M if purpose == "PV0" else (0.0, 0.0, 0.0),
        },
        "SensorWidth": size[0],
        "SensorHeight": size[1],
    } | more


def calibration(**colour: Any) -> bytes:
    cameras = [
        camera_json("D0", DEPTH_LENS, (1024, 1024)),
        camera_json("PV0", COLOUR_LENS, (4096, 3072), **colour),
    ]
    inertial = [
        {
            "BiasTemperatureModel": [0.0] * 12,
            "BiasUncertainty": [0.0001] * 3,
            "MixingMatrixTemperatureModel": [0.0] * 36,
            "ModelTypeMask": 16,
            "Noise": [0.001] * 6,
            "Rt": {"Rotation": np.eye(3).ravel().tolist(), "Translation": [0.0] * 3},
            "SecondOrderScaling": [0.0] * 9,
            "SensorType": f"CALIBRATION_InertialSensorType_{kind}",
            "TemperatureBounds": [5.0, 60.0],
            "TemperatureC": 20.0,
        }
        for kind in ("Gyro", "Accelerometer")
    ]
    information = {"Cameras": cameras, "InertialSensors": inertial}
    return json.dumps({"CalibrationInformation": information}).encode()


def block(track_number: int, away_us: int, data: bytes) -> bytes:
    return element(0xA3, bytes([0x80 | track_number]) + struct.pack(">hB", away_us, 0x80) + data)


def write_kinect(
    path: Path,
    tracks: Iterable[bytes],
    images: Iterable[tuple[int, int, bytes]],
    *,
    attached: bytes | None = None,
    begin_ns: int = 1_700_000_000_000_000_000,
    title: str = "Azure Kinect",
) -> Path:
    """Write a recording; images are track, time in microseconds since its begin, data.

    A cluster is 32 ms long, as the recorder's.
    """
    since = struct.pack(">q", begin_ns - SINCE_2001_NS)
    info = parent(
        INFO,
        element(0x2AD7B1, 1000),
        element(0x4D80, "libmatroska-1.4.9"),
        element(0x5741, "k4arecord-1.4.1"),
        element(0x4461, since),
        element(0x7BA9, title),
    )
    files = (
        []
        if attached is None
        else [
            parent(
                0x61A7,
                element(0x466E, "calibration.json"),
                element(0x4660, "application/octet-stream"),
                element(0x46AE, 77),
                element(0x465C, attached),
            )
        ]
    )
    tags = [
        tag("K4A_DEPTH_MODE", "NFOV_2X2BINNED", 2),
        tag("K4A_IR_MODE", "ACTIVE", 3),
        tag("K4A_COLOR_FIRMWARE_VERSION", "1.6.110"),
        tag("K4A_DEVICE_SERIAL_NUMBER", "000123456789"),
        tag("K4A_START_OFFSET_NS", "345000"),
    ]
    clusters: dict[int, list[tuple[int, int, bytes]]] = {}
    for number, time_us, data in sorted(images, key=lambda one: one[1]):
        clusters.setdefault(time_us // 32_000, []).append((number, time_us, data))
    body = [
        element(VOID, bytes(1024)),
        info,
        parent(TRACKS, *tracks),
        parent(ATTACHMENTS, *files) if files else b"",
        parent(TAGS, *tags),
        *(
            parent(
                CLUSTER,
                element(0xE7, blocks[0][1]),
                *(block(number, time - blocks[0][1], data) for number, time, data in blocks),
            )
            for blocks in clusters.values()
        ),
    ]
    head = parent(EBML, element(0x4282, "matroska"), element(0x4287, 2), element(0x4285, 2))
    path.write_bytes(head + parent(SEGMENT, *body))
    return path


def depth_image() -> np.ndarray:
    """A wall across the depth camera's view, and before it a board of 60 × 60 pixels."""
    depth = np.full(NARROW[::-1], round(1000 * WALL_M), np.uint16)
    depth[BOARD] = round(1000 * BOARD_M)
    return depth


def jpeg(size: tuple[int, int] = WIDE) -> bytes:
    pixels = np.full((size[1], size[0], 3), (200, 20, 10), np.uint8)
    return simplejpeg.encode_jpeg(pixels, 90, "RGB", "422")


def tracks(colour: bytes = b"MJPG", bits: int = 24, size: tuple[int, int] = WIDE) -> list[bytes]:
    return [
        track(COLOUR, "COLOR", size, colour, bits),
        track(DEPTH, "DEPTH", NARROW, b"b16g", 16),
        track(IR, "IR", NARROW, b"b16g", 16),
    ]


def images(colour: bytes, frames: int = 3, kinds: tuple[int, ...] = (COLOUR, DEPTH, IR)) -> Any:
    depth = depth_image().astype(">u2").tobytes()
    for number in range(frames):
        for kind in kinds:
            late = 0 if kind == COLOUR else LATE_US
            yield kind, number * FRAME_US + late, colour if kind == COLOUR else depth
