"""Folders of the TUM RGB-D benchmark become recordings: our own exports, and the real layout."""

import json
from importlib.metadata import version
from pathlib import Path

import cv2
import inhand_recorder
import numpy as np
import pytest
from exported import export
from inhand_recorder.verification import verify_recording
from inhand_runtime.recording import read_metadata
from small_rig import CAMERA, FRAME_NS, START_NS, depth_of, pose_of, write_rig

from inhand.__main__ import main
from inhand.exports.tum import export_tum

S, C = np.sin(0.25), np.cos(0.25)


def bring(folder: Path, output: Path, *more: str) -> int:
    return main(["recording", "import", str(folder), "--from", "tum", "-o", str(output), *more])


@pytest.fixture
def benchmark(tmp_path: Path) -> Path:
    """A folder as the benchmark's own: lists with times of their own, the camera's poses at 100 Hz
    as it moves along x by 1 m/s, turned by half a radian about y; depth has 5000 units a metre."""
    folder = tmp_path / "rgbd_dataset_freiburg1_xyz"
    for name, shape, shift in (("rgb", (48, 64, 3), 0.0), ("depth", (48, 64), 0.004)):
        (folder / name).mkdir(parents=True)
        lines = [
            "# color images",
            "# file: 'rgbd_dataset_freiburg1_xyz.bag'",
            "# timestamp filename",
        ]
        for number in range(5):
            time = f"{1305031102.175304 + number / 30 + shift:.6f}"
            if (name, number) == ("depth", 3):
                continue
            pixels = np.full(shape, 5000 * number if name == "depth" else 90, np.uint16)
            if name == "rgb":
                pixels = pixels.astype(np.uint8)
            cv2.imwrite(str(folder / name / f"{time}.png"), pixels)
            lines.append(f"{time} {name}/{time}.png")
        (folder / f"{name}.txt").write_text("\n".join(lines) + "\n")
    truth = ["# ground truth trajectory", "# timestamp tx ty tz qx qy qz qw"]
    for number in range(30):
        seconds = 1305031102.1 + number / 100
        truth.append(f"{seconds:.4f} {number / 100:.4f} 0.0000 2.0000 0.0 {S:.6f} 0.0 {C:.6f}")
    (folder / "groundtruth.txt").write_text("\n".join(truth) + "\n")
    return folder


def test_what_we_exported_comes_back(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    export(export_tum, write_rig(tmp_path / "one.mcap"), tmp_path / "tum")
    back = tmp_path / "back.mcap"
    assert bring(tmp_path / "tum", back, "--camera", "front", "--json", str(tmp_path / "j")) == 0
    assert capsys.readouterr().out == f"{back}: 1 info/front, 10 rgbd/front, 10 label/mug\n"
    assert json.loads((tmp_path / "j").read_text())["counts"]["rgbd/front"] == 10
    assert verify_recording(back) == []
    about = read_metadata(back)["import"]
    assert (about["source"], about["format"]) == ("tum", "tum")
    assert about["version"] == f"inhand {version('inhand')}"
    with inhand_recorder.open(back) as recording:
        info = recording.infos["front"]
        assert (info.fx, info.cy, info.width) == (CAMERA.fx, CAMERA.cy, CAMERA.width)
        assert info.depth_scale == pytest.approx(0.001)
        for number, (frame, label) in enumerate(
            zip(recording["rgbd/front"], recording["label/mug"], strict=True)
        ):
            assert frame.time_ns == label.time_ns == START_NS + number * FRAME_NS
            np.testing.assert_array_equal(frame.depth, depth_of(number))
            assert frame.colour.shape == (48, 64, 3)
            assert label.message.camera_from_object == pose_of(number)


def test_the_benchmarks_own_layout_is_paired_by_time_and_its_room_is_an_object(
    benchmark: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "xyz.mcap"
    assert bring(benchmark, output) == 1
    assert "525 525 319.5 239.5 640 480 5000" in capsys.readouterr().err
    (benchmark / "camera.txt").write_text("60 60 31.5 23.5 64 48 5000\n")
    assert bring(benchmark, output) == 0
    assert "1 of 5 frames have no depth within 20 ms\n" in capsys.readouterr().out
    assert verify_recording(output) == []
    with inhand_recorder.open(output) as recording:
        frames = list(recording["rgbd/camera"])
        assert frames[0].time_ns == 1305031102175304000
        assert frames[0].message.time_uncertainty_ns == 4_000_000
        assert recording.infos["camera"].frame_rate == pytest.approx(30.0, rel=1e-3)
        assert [frame.depth is None for frame in frames] == [False, False, False, True, False]
        np.testing.assert_allclose(frames[2].depth_m, 2.0)
        for frame, room in zip(frames, recording["label/world"], strict=True):
            along_m = frame.time_ns / 1e9 - 1305031102.1
            # The camera is at (along, 0, 2), turned by 0.5 rad about y: x' = R(-0.5) (x - t).
            turn = np.array([[np.cos(0.5), -np.sin(0.5)], [np.sin(0.5), np.cos(0.5)]])
            x, z = turn @ [-along_m, -2.0]
            shown = room.message.camera_from_object
            np.testing.assert_allclose(shown.translation, (x, 0.0, z), atol=5e-6)
            assert abs(np.dot(shown.rotation, (C, 0.0, -S, 0.0))) == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize(
    ("file", "text", "said"),
    [
        ("rgb.txt", "12.5 ../../secret.png\n", "outside of the folder"),
        ("rgb.txt", "12.5 a.png\n12.4 b.png\n", "line 2: times must rise"),
        ("rgb.txt", "noon a.png\n", "'noon' is no time in seconds"),
        ("rgb.txt", "12.5 a.png\n", "cannot read"),
        ("camera.txt", "60 60 31.5\n", "write fx fy cx cy width height depth_factor"),
        ("camera.txt", "60 60 31.5 23.5 64 48 0\n", "division by zero"),
        ("groundtruth.txt", "1 0 0 0 0 0 0 9\n", "no unit quaternion"),
        ("groundtruth.txt", "1 0 0 nan 0 0 0 1\n", "'nan' is no number"),
    ],
)
def test_what_is_wrong_in_a_folder_is_said_and_nothing_is_made(
    file: str, text: str, said: str, benchmark: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (benchmark / "camera.txt").write_text("60 60 31.5 23.5 64 48 5000\n")
    (benchmark / file).write_text(text)
    assert bring(benchmark, benchmark.parent / "out.mcap") == 1
    assert said in capsys.readouterr().err
    assert [one.name for one in benchmark.parent.iterdir()] == [benchmark.name]
