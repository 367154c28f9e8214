"""Checks imports of a RealSense with librealsense itself, which is too large for the tests.

``python tests/scenes/librealsense_agrees.py PYTHON SUFFIX``: PYTHON has ``pyrealsense2``, up to
2.57 for ``.bag`` and later for ``.db3``. It records a device of software: a wall and a board before
it, a colour camera with distortion, moved and turned against the depth camera. Inhand imports the
file, and librealsense plays it back and aligns its depth.
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

WIDTH, HEIGHT, FRAMES = 640, 480, 5
UNITS_M = 0.0005
SHIFT_M, TURN_RAD = (-0.05, 0.002, 0.001), 0.02


def record(path: str) -> None:
    """Write a file as librealsense does; runs where ``pyrealsense2`` is."""
    import pyrealsense2 as rs

    device = rs.software_device()
    device.register_info(rs.camera_info.name, "Intel RealSense D435")

    def stream(name, kind, layout, focal, coefficients):  # type: ignore[no-untyped-def]
        lens = rs.intrinsics()
        lens.width, lens.height, lens.fx, lens.fy = WIDTH, HEIGHT, focal, focal
        lens.ppx, lens.ppy = (WIDTH - 1) / 2, (HEIGHT - 1) / 2
        lens.model, lens.coeffs = rs.distortion.inverse_brown_conrady, coefficients
        video = rs.video_stream()
        video.type, video.index, video.uid, video.fps = kind, 0, int(kind), 30
        video.width, video.height, video.fmt, video.intrinsics = WIDTH, HEIGHT, layout, lens
        video.bpp = 2 if kind == rs.stream.depth else 3
        sensor = device.add_sensor(name)
        return sensor, sensor.add_video_stream(video)

    of_depth = stream("Stereo Module", rs.stream.depth, rs.format.z16, 600.0, [0.0] * 5)
    lens = [0.05, -0.08, 0.001, -0.0005, 0.01]
    of_colour = stream("RGB Camera", rs.stream.color, rs.format.rgb8, 620.0, lens)
    of_depth[0].add_read_only_option(rs.option.depth_units, UNITS_M)
    c, s = np.cos(TURN_RAD), np.sin(TURN_RAD)
    place = rs.extrinsics()
    place.rotation, place.translation = [c, s, 0, -s, c, 0, 0, 0, 1], list(SHIFT_M)
    of_depth[1].register_extrinsics_to(of_colour[1], place)
    recorder = rs.recorder(path, device)
    queue = rs.frame_queue(50)
    sensors = recorder.query_sensors()
    for sensor, (_, profile) in zip(sensors, (of_depth, of_colour), strict=True):
        sensor.open(profile)
        sensor.start(queue)
    depth = np.full((HEIGHT, WIDTH), round(1.0 / UNITS_M), np.uint16)
    depth[200:300, 260:360] = round(0.5 / UNITS_M)
    colour = np.full((HEIGHT, WIDTH, 3), (200, 20, 10), np.uint8)
    begin_ms, kept = time.time() * 1000, []
    for number in range(FRAMES):
        for (sensor, profile), pixels in ((of_depth, depth), (of_colour, colour)):
            frame = rs.software_video_frame()
            frame.pixels, frame.stride = pixels, pixels.strides[0]
            frame.bpp = pixels.strides[1]
            frame.timestamp = begin_ms + 33.3 * number
            frame.domain, frame.frame_number = rs.timestamp_domain.system_time, number
            frame.profile = profile.as_video_stream_profile()
            if pixels is depth:
                frame.depth_units = UNITS_M
            kept.append(frame)
            sensor.on_video_frame(frame)
        time.sleep(0.05)
    time.sleep(0.5)
    for sensor in sensors:
        sensor.stop()
        sensor.close()


def align(path: str, output: str) -> None:
    """Save the last frame's depth as librealsense aligns it; runs where ``pyrealsense2`` is."""
    import pyrealsense2 as rs

    pipeline, settings = rs.pipeline(), rs.config()
    settings.enable_device_from_file(path, repeat_playback=False)
    pipeline.start(settings).get_device().as_playback().set_real_time(False)
    aligner, found = rs.align(rs.stream.color), None
    while True:
        try:
            frames = pipeline.wait_for_frames(2000)
        except RuntimeError:  # the end of the file
            break
        found = np.array(aligner.process(frames).get_depth_frame().get_data())
    np.save(output, found)


def main(python: str, suffix: str) -> None:
    """Record, import, align and print how far both agree."""
    import inhand_recorder

    with tempfile.TemporaryDirectory() as folder:
        path, ours, theirs = (f"{folder}/{name}" for name in (f"a{suffix}", "a.mcap", "a.npy"))
        subprocess.run([python, __file__, "record", path], check=True)
        subprocess.run([python, __file__, "align", path, theirs], check=True)
        command = [sys.executable, "-m", "inhand", "recording", "import", path]
        subprocess.run([*command, "--from", "ros", "-o", ours], check=True)
        with inhand_recorder.open(Path(ours)) as recording:
            frames = list(recording["rgbd/camera"])
        depth, true = frames[-1].depth.astype(int), np.load(theirs).astype(int)
    both = (depth > 0) & (true > 0)
    # librealsense keeps the number that the depth camera measured, which is 1 mm nearer.
    off = np.abs(depth - true - round(SHIFT_M[2] / UNITS_M))[both]
    print(
        f"{len(frames)} frames; of {depth.size:,} pixels {both.sum():,} have depth in both, "
        f"{np.count_nonzero(depth > 0) - both.sum():,} in ours alone and "
        f"{np.count_nonzero(true > 0) - both.sum():,} in theirs alone; "
        f"{np.count_nonzero(off):,} of those in both differ"
    )
    assert len(frames) == FRAMES
    assert np.mean(both) > 0.95
    assert np.count_nonzero(off) < 0.001 * both.sum()


if __name__ == "__main__":
    {"record": record, "align": align}.get(sys.argv[1], main)(
        *sys.argv[1 if sys.argv[1] not in ("record", "align") else 2 :]
    )
