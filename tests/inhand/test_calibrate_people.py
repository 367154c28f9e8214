"""`inhand calibrate --people` on recordings of cameras that are not as one would have them."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from inhand_calibration.from_people.skeletons import CameraSkeletons
from inhand_runtime.rig_calibration import read_rig_calibration
from inhand_schemas.messages import CameraInfo, Person, Skeletons
from inhand_schemas.topics import INFO, SKELETONS
from played import CAMERA_INFO, Entry, write
from wanderers import BACK, FRONT, LEFT, pacing_movement, true_movement, watch, with_joints

from inhand.__main__ import main

FASTER = replace(LEFT, frame_rate=30.0)
WALK = true_movement(1)
SEEN = [watch(camera, WALK) for camera in (FRONT, FASTER, BACK)]
"""What a camera, one of twice its rate, and one whose clock is 2 s off see."""


def person(joints: np.ndarray, confidences: np.ndarray) -> Person:
    return Person(
        id=0,
        joints=tuple(map(tuple, joints.tolist())),
        states=("tracked",) * 20,
        confidences=tuple(confidences.tolist()),
    )


def recorded(folder: Path, cameras: Sequence[CameraSkeletons], silent: str = "") -> list[str]:
    """A recording of each camera; one that sees nobody sends empty skeletons, a silent one none."""
    folder.mkdir()
    paths = []
    for seen in cameras:
        info: CameraInfo = CAMERA_INFO
        entries: list[Entry] = [(INFO, seen.name, info)]
        for number, time_ns in enumerate(seen.times_ns.tolist()):
            one = seen.joints[number], seen.confidences[number]
            people = () if np.isnan(one[0]).any() else (person(*one),)
            skeletons = Skeletons(sequence=number, time_ns=time_ns, people=people)
            entries += [] if seen.name == silent else [(SKELETONS, seen.name, skeletons)]
        paths.append(str(write(folder / f"{seen.name}.mcap", entries)))
    return paths


def blind(seen: CameraSkeletons) -> CameraSkeletons:
    return with_joints(seen, np.full_like(seen.joints, np.nan))


@pytest.fixture(scope="module")
def calibration(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("people")
    paths = recorded(folder / "all", SEEN)
    file = folder / "cameras.toml"
    assert main(["calibrate", "--people", *paths, "--origin", "front", "-o", str(file)]) == 0
    return file


def test_a_clock_two_seconds_off_and_another_rate_need_nothing_said(calibration: Path) -> None:
    found = read_rig_calibration(calibration).cameras
    assert found["back"].clock_offset_ns == pytest.approx(-2_000_000_000, abs=5_000_000)
    assert found["left"].clock_offset_ns == pytest.approx(300_000_000, abs=15_000_000)


def test_a_camera_that_follows_nobody_is_named_with_what_turns_its_picture(
    tmp_path: Path, calibration: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    paths = recorded(tmp_path / "upside", [SEEN[0], blind(SEEN[1]), SEEN[2]])
    output = tmp_path / "cameras.toml"
    assert main(["calibrate", "--people", *paths, "-o", str(output)]) == 1
    said = capsys.readouterr().err
    assert "left followed nobody" in said
    assert "rotate = 180" in said
    assert not output.exists()
    assert main(["calibrate", "--people", *paths, "--check", str(calibration)]) == 1
    said = capsys.readouterr().out
    assert "NOT CHECKED: left" in said
    assert "the cameras that were compared agree" in said


def test_a_camera_without_skeletons_is_said(
    tmp_path: Path, calibration: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    paths = recorded(tmp_path / "silent", SEEN, silent="left")
    output = tmp_path / "cameras.toml"
    assert main(["calibrate", "--people", *paths, "-o", str(output)]) == 0
    said = capsys.readouterr().out
    assert (
        "left sent no skeletons, and is left out: a source that has none of its own takes" in said
    )
    assert set(read_rig_calibration(output).cameras) == {"front", "back"}
    assert main(["calibrate", "--people", *paths, "--check", str(calibration)]) == 1
    assert "NOT CHECKED: left" in capsys.readouterr().out


def test_a_wrong_calibration_is_found_and_the_camera_named(
    tmp_path: Path, calibration: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    moved = replace(FASTER, height=FASTER.height + 0.15)
    seen = [SEEN[0], watch(moved, WALK), SEEN[2]]
    paths = recorded(tmp_path / "bumped", seen)
    assert main(["calibrate", "--people", *paths, "--check", str(calibration)]) == 1
    said = capsys.readouterr().out
    assert "WRONG: left was moved" in said
    assert "NOT CHECKED" not in said
    late = replace(SEEN[0], times_ns=SEEN[0].times_ns + 2_000_000_000)
    paths = recorded(tmp_path / "late", [late, *SEEN[1:]])
    assert main(["calibrate", "--people", *paths, "--check", str(calibration)]) == 1
    assert "WRONG: front has another time" in capsys.readouterr().out


def test_walking_to_and_fro_is_enough_where_clocks_are_said_to_be_nearly_right(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    walk = pacing_movement()
    paths = recorded(tmp_path / "pacing", [watch(FRONT, walk), watch(LEFT, walk)])
    output = tmp_path / "cameras.toml"
    command = ["calibrate", "--people", *paths, "--origin", "front", "-o", str(output)]
    assert main(command) == 1
    assert "--clocks-within 0.5" in capsys.readouterr().err
    assert main([*command, "--clocks-within", "0.5"]) == 0
    left = read_rig_calibration(output).cameras["left"]
    assert left.clock_offset_ns == pytest.approx(300_000_000, abs=15_000_000)
