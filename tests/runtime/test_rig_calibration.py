"""The calibration file of a rig: what is written is read, and what is wrong in it is said."""

import os
from datetime import UTC, datetime
from pathlib import Path

import pytest
from inhand_runtime.errors import InhandError, SettingsError
from inhand_runtime.rig_calibration import (
    CameraCalibration,
    RigCalibration,
    calibration_of,
    read_rig_calibration,
    require_place_for_calibration,
    write_rig_calibration,
)
from inhand_schemas.messages import Pose

MADE = datetime(2026, 11, 30, 12, 0, 1, tzinfo=UTC)
FRONT = CameraCalibration(
    Pose((0.1, -2.0, 1.25), (0.5, -0.5, 0.5, -0.5)),
    (0.001, 0.002, 0.0015),
    (1e-4, 2e-4, 3e-4),
    "board",
    MADE,
)
LEFT = CameraCalibration(
    Pose((1.0 / 3.0, 0.0, 1e-17), (1.0, 0.0, 0.0, 0.0)),
    (0.01, 0.02, 0.015),
    (1e-2, 2e-2, 3e-2),
    "people",
    MADE,
    clock_offset_ns=-2_000_000_123,
    clock_deviation_ns=4_000_000,
)
RIG = RigCalibration({"front": FRONT, "left": LEFT}, 'on the floor, z up: "board" \\ here')


@pytest.fixture
def written(tmp_path: Path) -> Path:
    path = tmp_path / "rig.toml"
    write_rig_calibration(path, RIG)
    return path


def test_what_is_written_is_read_to_the_last_bit(written: Path) -> None:
    assert read_rig_calibration(written) == RIG
    assert [one.name for one in written.parent.iterdir()] == ["rig.toml"]


def test_one_camera_is_read_by_its_name_and_another_one_is_refused(written: Path) -> None:
    assert calibration_of(written, "left") == LEFT
    with pytest.raises(SettingsError, match=r"does not calibrate the camera frnt \(did you mean "):
        calibration_of(written, "frnt")


def test_the_clock_of_a_camera_that_was_not_estimated_is_the_rigs() -> None:
    assert RIG.clock_offset_ns("left") == -2_000_000_123
    assert RIG.clock_offset_ns("front") == RIG.clock_offset_ns("nobody") == 0


@pytest.mark.parametrize(
    ("was", "wrong", "said"),
    [
        ("[0.5, -0.5, 0.5, -0.5]", "[0.5, 0.5, 0.5, 0.6]", "cameras.front.rotation: it is no unit"),
        ("[0.1, -2.0, 1.25]", "[0.1, nan, 1.25]", "cameras.front.translation"),
        ("[0.1, -2.0, 1.25]", "[0.1, -2.0]", "cameras.front.translation"),
        ("[0.001, ", "[-0.001, ", "cameras.front.translation_deviation"),
        ("[0.1, -2.0, 1.25]", "[0.1, 1e308, 1.25]", "less than or equal to 1000"),
        ("[0.001, ", "[1e200, ", "less than or equal to 1000"),
        ("clock_offset_ns = -", "clock_offset_ns = -99999999999999", "greater than or equal to"),
        ('method = "board"', 'method = "bord"', "there is no 'bord' (did you mean board?)"),
        ("version = 1", "version = 2", "for a later release of Inhand"),
        ("version = 1", "", "setting version is missing"),
        ("[cameras.front]", "[cameras.Front]", "Front"),
        ("clock_offset_ns", "clock_ofset_ns", "did you mean clock_offset_ns?"),
        ("12:00:01Z", "12:00:01", "cameras.front.made"),
        ("version", "version version", "is no TOML"),
    ],
)
def test_what_is_wrong_in_a_file_is_said_with_its_place(
    written: Path, was: str, wrong: str, said: str
) -> None:
    text = written.read_text()
    assert was in text
    written.write_text(text.replace(was, wrong))
    with pytest.raises(SettingsError) as error:
        read_rig_calibration(written)
    assert said in str(error.value)
    assert str(written) in str(error.value)


def test_a_file_that_is_not_there_and_one_that_cannot_be_written_are_said(tmp_path: Path) -> None:
    with pytest.raises(SettingsError, match="cannot read"):
        read_rig_calibration(tmp_path / "rig.toml")
    os.mkfifo(tmp_path / "pipe.toml")
    with pytest.raises(SettingsError, match=r"pipe\.toml is a pipe: name a file"):
        read_rig_calibration(tmp_path / "pipe.toml")
    with pytest.raises(InhandError, match="cannot write"):
        write_rig_calibration(Path("/proc/rig.toml"), RIG)
    (tmp_path / "file").touch()
    with pytest.raises(InhandError, match="cannot write"):
        write_rig_calibration(tmp_path / "file" / "rig.toml", RIG)


def test_the_folder_of_a_file_is_made(tmp_path: Path) -> None:
    write_rig_calibration(tmp_path / "new" / "rig.toml", RIG)
    assert read_rig_calibration(tmp_path / "new" / "rig.toml") == RIG


def test_settings_are_not_written_over_by_a_calibration(written: Path) -> None:
    require_place_for_calibration(written)
    require_place_for_calibration(written.with_name("new.toml"))
    settings = written.with_name("settings.toml")
    settings.write_text('[capture.front]\nsource = "oak"\n')
    with pytest.raises(SettingsError, match="is not written over, since it is no calibration"):
        require_place_for_calibration(settings)
