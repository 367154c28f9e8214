"""A file that was cut off or damaged anywhere ends in one line, or in a recording that is sound."""

import random
from collections.abc import Callable
from pathlib import Path

import pytest
from azure_kinect import DEPTH, calibration, images, tracks, write_kinect
from inhand_recorder.verification import verify_recording
from realsense_bag import write_bag, write_db3
from ros_bags import bag
from small_rig import FRAME_NS, START_NS, depth_of

from inhand.__main__ import main

VARIANTS = 12


def realsense(folder: Path) -> Path:
    return write_bag(folder / "whole.bag")


def realsense_db3(folder: Path) -> Path:
    return write_db3(folder / "whole")


def sqlite(folder: Path) -> Path:
    return rosbag2(folder, "sqlite", "db3")


def mcap(folder: Path) -> Path:
    return rosbag2(folder, "mcap", "mcap")


def rosbag2(folder: Path, kind: str, suffix: str) -> Path:
    with bag(folder / "whole", kind) as (ros, put):
        for number in range(3):
            time_ns = START_NS + number * FRAME_NS
            put("/d/image", "Image", time_ns, ros.image(time_ns, depth_of(number), "16UC1"))
            put("/d/camera_info", "CameraInfo", time_ns, ros.lens(time_ns))
    return next((folder / "whole").glob(f"*.{suffix}"))


def kinect(folder: Path) -> Path:
    frames = images(b"", frames=2, kinds=(DEPTH,))
    return write_kinect(folder / "whole.mkv", tracks()[1:], frames, attached=calibration())


def spoilt(data: bytes, chance: random.Random, number: int) -> bytes:
    """Cut off, or with bytes that were changed: anywhere, or among the first ones."""
    if number % 3 == 0:
        return data[: chance.randrange(len(data))]
    changed = bytearray(data)
    for _ in range(4):
        last = len(data) if number % 3 == 1 else min(len(data), 6000)
        changed[chance.randrange(last)] = chance.randrange(256)
    return bytes(changed)


@pytest.mark.parametrize("write", [realsense, realsense_db3, sqlite, mcap, kinect])
def test_damage_is_told_in_a_line_or_does_no_harm(
    write: Callable[[Path], Path], tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    whole = write(tmp_path)
    data, chance = whole.read_bytes(), random.Random(write.__name__)
    kind, output = "kinect" if write is kinect else "ros", tmp_path / "out.mcap"
    for number in range(VARIANTS):
        damaged = tmp_path / f"damaged{whole.suffix}"
        damaged.write_bytes(spoilt(data, chance, number))
        code = main(["recording", "import", str(damaged), "--from", kind, "-o", str(output)])
        said = capfd.readouterr().err
        if code == 0:
            assert verify_recording(output) == []
            output.unlink()
            continue
        assert code == 1
        assert len([line for line in said.splitlines() if line.startswith("inhand ")]) == 1
        assert not list(tmp_path.glob("out*"))
