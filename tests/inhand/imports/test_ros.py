"""Bags of ROS 1 and 2 become recordings with the figures that ``rosbags`` reads in them."""

from pathlib import Path

import inhand_recorder
import numpy as np
import pytest
import simplejpeg
from inhand_recorder.verification import verify_recording
from inhand_runtime.recording import read_metadata
from ros_bags import bag
from small_rig import FRAME_NS, HEIGHT, START_NS, WIDTH, colour_of, depth_of

from inhand.__main__ import main

COLOUR, DEPTH = "/camera/color/image_raw/compressed", "/camera/aligned_depth/image_raw"
INFO = "/camera/color/camera_info"
LATE_NS = 5_000_000


def jpeg_of(number: int) -> bytes:
    return simplejpeg.encode_jpeg(colour_of(number), 95, "RGB", "444")


def bring(source: Path, output: Path, *more: str) -> int:
    return main(["recording", "import", str(source), "--from", "ros", "-o", str(output), *more])


@pytest.mark.parametrize("kind", ["ros1", "sqlite", "mcap"])
def test_frames_are_those_of_the_bag(
    kind: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    source = tmp_path / ("a.bag" if kind == "ros1" else "a")
    with bag(source, kind) as (ros, put):
        for number in range(6):
            time_ns = START_NS + number * FRAME_NS
            depth = depth_of(number).astype(">u2" if number % 2 else "<u2")
            if number != 4:
                image = ros.image(time_ns + 3000, depth, "16UC1")
                put(DEPTH, "Image", time_ns + LATE_NS, image)
            put(
                COLOUR, "CompressedImage", time_ns + 2 * LATE_NS, ros.jpeg(time_ns, jpeg_of(number))
            )
            put(INFO, "CameraInfo", time_ns + 2 * LATE_NS, ros.lens(time_ns))
    output = tmp_path / "out.mcap"
    source = source / "a.mcap" if kind == "mcap" else source
    assert bring(source, output, "--camera", "front", "--rig", "kitchen") == 0
    said = capsys.readouterr().out
    assert f"{output}: 1 info/front, 6 rgbd/front\n" in said
    assert f"depth of {DEPTH}\n" in said
    assert "1 of 6 frames have no depth within 20 ms" in said
    assert verify_recording(output) == []
    assert read_metadata(output)["import"]["colour"] == COLOUR
    with inhand_recorder.open(output) as recording:
        info = recording.infos["front"]
        assert (info.fx, info.fy, info.cx, info.cy) == (60.0, 61.0, 31.5, 23.5)
        assert info.distortion == (0.1, -0.05, 0.0, 0.0, 0.01)
        frames = list(recording["inhand/@v1/kitchen/rgbd/front"])
        assert [frame.time_ns for frame in frames] == [START_NS + n * FRAME_NS for n in range(6)]
        for number, frame in enumerate(frames):
            assert frame.received_ns == frame.time_ns + 2 * LATE_NS
            assert frame.message.colour.data == jpeg_of(number)
            if number == 4:
                assert frame.depth is None
                continue
            assert frame.message.time_uncertainty_ns == 3000
            np.testing.assert_array_equal(frame.depth, depth_of(number))


def test_metres_become_millimetres_and_raw_colour_is_coded(tmp_path: Path) -> None:
    metres = (depth_of(0) / 1000.0).astype("<f4")
    metres[0, 0], metres[0, 1], metres[0, 2] = np.nan, 70.0, np.inf
    bgr = np.ascontiguousarray(np.full((HEIGHT, WIDTH, 3), (10, 20, 200), np.uint8))
    with bag(tmp_path / "a", "sqlite") as (ros, put):
        put("/d/image", "Image", START_NS, ros.image(START_NS, metres, "32FC1"))
        put("/c/image", "Image", START_NS, ros.image(START_NS, bgr, "bgr8"))
        put("/c/camera_info", "CameraInfo", START_NS, ros.lens(START_NS))
    assert bring(tmp_path / "a", tmp_path / "out.mcap") == 0
    with inhand_recorder.open(tmp_path / "out.mcap") as recording:
        (frame,) = recording["rgbd/camera"]
        np.testing.assert_array_equal(frame.depth, depth_of(0))
        np.testing.assert_allclose(frame.colour[20, 20], (200, 20, 10), atol=3)


def test_what_is_not_clear_or_missing_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    depth, output = depth_of(0), tmp_path / "out.mcap"
    with bag(tmp_path / "two", "sqlite") as (ros, put):
        for topic in ("/left/image", "/right/image"):
            put(topic, "Image", START_NS, ros.image(START_NS, depth, "16UC1"))
    with bag(tmp_path / "odd", "sqlite") as (ros, put):
        bayer = np.zeros((HEIGHT, WIDTH), np.uint8)
        put("/c/image", "Image", START_NS, ros.image(START_NS, bayer, "bayer_rggb8"))
        put("/c/camera_info", "CameraInfo", START_NS, ros.lens(START_NS))
    (tmp_path / "text.bag").write_text("no bag")
    for source, more, said in (
        ("two", (), "choose one with --depth: /left/image, /right/image"),
        ("two", ("--depth", "/up"), "--depth /up: there is no such topic"),
        ("two", ("--depth", "/left/image"), "no CameraInfo is in it"),
        ("odd", (), "no frame of it can be read: /c/image: colour in 'bayer_rggb8' is not read"),
        ("text.bag", (), "is no bag of ROS that can be read"),
        ("none", (), "is no bag of ROS that can be read"),
    ):
        assert bring(tmp_path / source, output, *more) == 1
        assert said in capsys.readouterr().err
    assert not output.exists()
