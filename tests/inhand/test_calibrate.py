"""`inhand calibrate` from the command line: boards, recordings, a rig that runs, and checks."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from inhand_calibration.from_board.board import printed_board
from inhand_calibration.from_board.lens import Lens
from inhand_calibration.rigid import angle, inverse, of_pose
from inhand_lab.benchmarks.board_calibration import frame_of, info_of, view_at
from inhand_lab.sensing.board_walk import (
    START_NS,
    RigCamera,
    WalkParameters,
    board_walk,
    is_seen,
    looking_at,
)
from inhand_runtime.rig_calibration import read_rig_calibration, write_rig_calibration
from inhand_schemas.keys import Site
from inhand_schemas.messages import Pose
from inhand_schemas.topics import INFO, RGBD
from played import Entry, write
from running_rig import RunningRig
from small_rig import write_rig

from inhand.__main__ import main

LENS = Lens(525.0, 525.0, 319.5, 239.5, 640, 480)
MIDDLE = np.array([0.0, 0.0, 1.1])
CAMERAS = tuple(
    RigCamera(name, LENS, looking_at(np.array(place), MIDDLE), 15.0, 0.0, phase)
    for name, place, phase in (("front", (1.0, 0.2, 1.3), 0.0), ("left", (0.8, -0.7, 1.0), 0.02))
)
PATIENCE_S = 240.0
"""Seconds for what takes ten where nothing else runs."""
WALK = WalkParameters(holds=7, hold_s=0.3, move_s=0.2, reach=(0.1, 0.15, 0.12))


@pytest.fixture(scope="module")
def recordings(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """What two cameras recorded, each by itself, of a board that is shown to them."""
    folder, random = tmp_path_factory.mktemp("board"), np.random.default_rng(31)
    walk = board_walk(printed_board("a3"), CAMERAS, random, WALK)
    paths = []
    for camera in CAMERAS:
        entries: list[Entry] = [(INFO, camera.name, info_of(LENS))]
        for number, time in enumerate(camera.true_times(walk.seconds)):
            pose = inverse(camera.room_from_camera) @ walk.at(np.array([time]))[0]
            if not is_seen(walk.board, pose, 2.0):
                continue
            grey = view_at(walk, camera, float(time), random)
            frame = frame_of(grey, START_NS + round(1e9 * float(time)), number)
            entries.append((RGBD, camera.name, frame))
        paths.append(write(folder / f"{camera.name}.mcap", entries))
    return paths


@pytest.mark.long
def test_recordings_of_two_hosts_are_calibrated_and_checked(
    recordings: list[Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output, result = tmp_path / "cameras.toml", tmp_path / "result.json"
    assert main(["calibrate", *map(str, recordings), "-o", str(output), "--json", str(result)]) == 0
    said = capsys.readouterr().out
    assert "the board inhand-a3 is seen in" in said
    assert "front and left saw the board together in" in said
    calibration = read_rig_calibration(output)
    front, left = (of_pose(calibration.cameras[one.name].rig_from_camera) for one in CAMERAS)
    true = inverse(CAMERAS[0].room_from_camera) @ CAMERAS[1].room_from_camera
    found = inverse(front) @ left
    assert np.linalg.norm(found[:3, 3] - true[:3, 3]) < 0.004
    assert angle(found[:3, :3] @ true[:3, :3].T) < np.radians(0.2)
    assert json.loads(result.read_text())["cameras"]["left"]["intrinsics"] in ("right", "unsure")

    assert main(["calibrate", *map(str, recordings), "--check", str(output)]) == 0
    one = calibration.cameras["left"]
    x, y, z = one.rig_from_camera.translation
    bumped = replace(one, rig_from_camera=Pose((x + 0.05, y, z), one.rig_from_camera.rotation))
    cameras = {**calibration.cameras, "left": bumped}
    write_rig_calibration(output, replace(calibration, cameras=cameras))
    assert main(["calibrate", *map(str, recordings), "--check", str(output)]) == 1
    assert "moved" in capsys.readouterr().out


@pytest.mark.long
def test_a_rig_that_runs_is_calibrated(recordings: list[Path], rig: RunningRig) -> None:
    rig.configure(
        "\n".join(
            f'[capture.{path.stem}]\nsource = "replay"\n'
            f'[capture.{path.stem}.options]\nfile = "{path}"'
            for path in recordings
        )
    )
    output = rig.folder / "cameras.toml"
    verb = rig.inhand(
        "calibrate", "--config", rig.config, "--seconds", "14", "-o", output, "--origin", "left"
    )
    rig.inhand("up", "--config", rig.config)
    assert verb.popen.wait(PATIENCE_S) == 0, verb.stderr
    assert "20 are enough" in verb.stdout
    left = of_pose(read_rig_calibration(output).cameras["left"].rig_from_camera)
    assert left == pytest.approx(np.eye(4), abs=1e-9)


def test_a_board_is_made_and_the_way_to_use_it_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "board.pdf"
    assert main(["calibrate", "--board", str(path), "--paper", "a3"]) == 0
    assert path.read_bytes().startswith(b"%PDF")
    assert "inhand-a3, to print at 100 % on a3 paper" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([], "name the file for the calibration: -o cameras.toml"),
        (["--board", "b.pdf", "--people"], "--board makes a board to print, and nothing else"),
        (["--people", "-o", "c.toml", "--floor"], "--floor is for boards"),
        (["--people", "-o", "c.toml", "--origin", "board"], "--people sees no board"),
        (["-o", "c.toml", "--clocks-within", "1"], "--clocks-within is for --people"),
        (["--people", "--check", "c.toml", "--clocks-within", "1"], "for calibrating, not for"),
        (["-o", "c.toml", "--floor", "--origin", "front"], "--floor puts the origin on the floor"),
        (["--check"], "no calibration is named in the settings"),
        (["x.mcap", "-o", "c.toml", "--pattern", "8x6"], "is no board"),
    ],
)
def test_what_does_not_belong_together_is_refused(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    arguments: list[str],
    said: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["calibrate", *arguments]) == 2
    assert said in capsys.readouterr().err


def test_cameras_of_one_name_in_two_rigs_do_not_pass_for_one(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    paths = [write_rig(tmp_path / f"{rig}.mcap", site=Site(rig=rig)) for rig in ("hall", "kitchen")]
    output = tmp_path / "cameras.toml"
    assert main(["calibrate", "--people", *map(str, paths), "-o", str(output)]) == 1
    assert "kitchen/info/front is of another rig's camera front" in capsys.readouterr().err


def test_a_check_is_against_the_calibration_of_a_tracker_too(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    config = tmp_path / "rig.toml"
    config.write_text('[tracker.mug]\ncameras = ["a", "b"]\ncalibration = "cameras.toml"\n')
    assert main(["calibrate", "--check", "--config", str(config)]) == 2
    assert f"cannot read {tmp_path / 'cameras.toml'}" in capsys.readouterr().err


def test_settings_are_not_written_over(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    settings = tmp_path / "rig.toml"
    settings.write_text('[capture.front]\nsource = "oak"\n')
    assert main(["calibrate", "-o", str(settings)]) == 2
    assert "is not written over" in capsys.readouterr().err
    assert "oak" in settings.read_text()
