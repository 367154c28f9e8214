#!/usr/bin/env bash
# pyrealsense2 2.56.5: the images of a .bag are four bytes longer than sensor_msgs/Image.
#
# A RealSense .bag is a ROS 1 bag, and its connections name sensor_msgs/Image with ROS's own
# definition and checksum. One would bet that a strict reader of ROS 1 messages reads it. Each image
# has four more bytes behind its pixels, which no definition names: rosbags refuses every one of them,
# and camera infos are read.
#
# Output seen on 2026-11-30:
#   images: 5, of which rosbags refuses 5
#   bytes beyond the message: 4
#   camera infos: 1, of which rosbags refuses 0
#
# The script ends with 0 while that is so, and with 1 when it has changed.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    numpy==2.4.6 pyrealsense2==2.56.5.9235 rosbags==0.11.0
cat > "$folder/recorded.py" <<'PYTHON'
import struct
import sys
import time
from pathlib import Path

import numpy as np
import pyrealsense2 as rs
from rosbags.highlevel import AnyReader

WIDTH, HEIGHT, FRAMES = 64, 48, 5


def record(path: str) -> None:
    device = rs.software_device()
    lens = rs.intrinsics()
    lens.width, lens.height, lens.fx, lens.fy = WIDTH, HEIGHT, 60.0, 60.0
    lens.ppx, lens.ppy = WIDTH / 2, HEIGHT / 2
    lens.model, lens.coeffs = rs.distortion.none, [0.0] * 5
    video = rs.video_stream()
    video.type, video.index, video.uid, video.fps = rs.stream.depth, 0, 1, 30
    video.width, video.height, video.fmt, video.bpp = WIDTH, HEIGHT, rs.format.z16, 2
    video.intrinsics = lens
    sensor = device.add_sensor("Stereo Module")
    profile = sensor.add_video_stream(video)
    sensor.add_read_only_option(rs.option.depth_units, 0.001)
    recorder = rs.recorder(path, device)
    queue = rs.frame_queue(50)
    recorded = recorder.query_sensors()[0]
    recorded.open(profile)
    recorded.start(queue)
    pixels, kept = np.full((HEIGHT, WIDTH), 1000, np.uint16), []
    for number in range(FRAMES):
        frame = rs.software_video_frame()
        frame.pixels, frame.stride, frame.bpp = pixels, pixels.strides[0], 2
        frame.timestamp, frame.domain = 33.3 * number, rs.timestamp_domain.system_time
        frame.frame_number, frame.profile = number, profile.as_video_stream_profile()
        frame.depth_units = 0.001
        kept.append(frame)
        sensor.on_video_frame(frame)
        time.sleep(0.05)
    time.sleep(0.5)
    recorded.stop()
    recorded.close()


def length_of_image(data: bytes) -> int:
    """Bytes of a sensor_msgs/Image by its own counts: header, sizes, encoding, step, pixels."""
    at = 12
    at += 4 + struct.unpack_from("<I", data, at)[0] + 8
    at += 4 + struct.unpack_from("<I", data, at)[0] + 1 + 4
    return at + 4 + struct.unpack_from("<I", data, at)[0]


path = sys.argv[1]
record(path)
refused = {"sensor_msgs/msg/Image": [], "sensor_msgs/msg/CameraInfo": []}
beyond = set()
with AnyReader([Path(path)]) as reader:
    for connection, _, data in reader.messages():
        if connection.msgtype not in refused:
            continue
        try:
            reader.deserialize(data, connection.msgtype)
            refused[connection.msgtype].append(False)
        except Exception:
            refused[connection.msgtype].append(True)
        if connection.msgtype.endswith("Image"):
            beyond.add(len(data) - length_of_image(data))
images, infos = refused.values()
print(f"images: {len(images)}, of which rosbags refuses {sum(images)}")
print("bytes beyond the message:", *sorted(beyond))
print(f"camera infos: {len(infos)}, of which rosbags refuses {sum(infos)}")
sys.exit((all(images), len(images) > 0, beyond, any(infos)) != (True, True, {4}, False))
PYTHON
"$folder/venv/bin/python" "$folder/recorded.py" "$folder/device.bag"
