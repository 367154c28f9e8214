"""``inhand object new --from``: what stands on a table in a recording."""

from pathlib import Path

import numpy as np
import pytest
from inhand_lab.benchmarks.table_scene import camera_above, standing_at, table_depths
from inhand_lab.objects.turned_shapes import build_cup
from inhand_lab.sensing.cameras import KINECT
from inhand_lab.world.messages import camera_info
from inhand_runtime.pixels import encode_depth
from inhand_runtime.recording import RecordingWriter
from inhand_schemas.keys import Site
from inhand_schemas.messages import RgbdFrame
from inhand_schemas.topics import INFO, RGBD
from inhand_tracker.shape.shape import load_shape

from inhand.__main__ import main

FRAME_NS = 33_333_333


def write_depths(path: Path, depths: np.ndarray, cameras: tuple[str, ...] = ("front",)) -> Path:
    """A recording of depths (T, H, W) in metres by each of several cameras."""
    with RecordingWriter(path) as writer:
        for camera in cameras:
            info = camera_info(KINECT.intrinsics, 30.0)
            writer.write(
                INFO.key(Site(), camera),
                INFO.encode(info),
                received_ns=0,
                captured_ns=0,
                sequence=0,
            )
            for number, depth in enumerate(depths):
                time_ns = number * FRAME_NS
                image = encode_depth(np.rint(1000.0 * depth).astype(np.uint16))
                frame = RgbdFrame(sequence=number, time_ns=time_ns, depth=image)
                writer.write(
                    RGBD.key(Site(), camera),
                    RGBD.encode(frame),
                    received_ns=time_ns,
                    captured_ns=time_ns,
                    sequence=number,
                )
    return path


def new(folder: Path, recording: Path, *options: str) -> int:
    arguments = ["--dataset", str(folder), "--from", str(recording), *options]
    return main(["object", "new", "cup", *arguments])


@pytest.mark.long
def test_a_cup_on_a_table_becomes_an_object_of_its_size_with_the_residual_stated(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cup = build_cup("cup", 0.10, 0.08, 0.06)
    depths = table_depths(
        [(cup, standing_at(cup, 0.0, 0.0, 0.0))], camera_above(0.8, 0.6), seed=1, frames=12
    )
    assert new(tmp_path, write_depths(tmp_path / "a.mcap", depths)) == 0
    told = " ".join(capsys.readouterr().out.split())
    assert "a cup fits: height " in told
    assert "mm from its surface on average" in told
    shape = load_shape(tmp_path / "objects/cup")
    np.testing.assert_allclose(np.ptp(shape.vertices, axis=0), [0.08, 0.08, 0.10], atol=0.004)
    assert shape.symmetries[0].order == 0


@pytest.mark.parametrize(
    ("depths", "cameras", "line"),
    [
        (np.zeros((3, 480, 640)), ("front",), "holds 3 frames of depth: record 15 or more"),
        (np.zeros((9, 480, 640)), (), "describes no camera"),
        (np.zeros((9, 480, 640)), ("front", "side"), "describes 2 cameras (front, side)"),
        (np.zeros((9, 480, 640)), ("front",), "depth shows 0 points within 2 m"),
    ],
    ids=["short", "no camera", "two cameras", "no depth"],
)
def test_a_recording_that_shows_no_thing_is_refused_in_one_line(
    depths: np.ndarray,
    cameras: tuple[str, ...],
    line: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    recording = write_depths(tmp_path / "a.mcap", depths, cameras)
    assert new(tmp_path / "data", recording) == 1
    (told,) = capsys.readouterr().err.splitlines()
    assert line in told
    assert not (tmp_path / "data").exists()


def test_what_is_no_recording_is_refused_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert new(tmp_path / "data", tmp_path / "none.mcap") == 2
    assert "is no file: name a recording" in capsys.readouterr().err
    (tmp_path / "text.mcap").write_text("no recording")
    assert new(tmp_path / "data", tmp_path / "text.mcap") == 1
    assert len(capsys.readouterr().err.splitlines()) == 1


def test_options_of_other_ways_do_not_go_with_a_recording(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert new(tmp_path, tmp_path / "a.mcap", "--unit", "mm") == 2
    assert "--unit is for --mesh, and this is by --from" in capsys.readouterr().err
    assert new(tmp_path, tmp_path / "a.mcap", "--kind", "cup") == 2
    assert "--kind and --from both say what it is" in capsys.readouterr().err
