"""What can be known of a source before a start is checked before a start."""

from collections.abc import Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import inhand_capture.settings as service
import pytest
from inhand_runtime.errors import SettingsError
from inhand_runtime.rig_calibration import (
    CameraCalibration,
    RigCalibration,
    write_rig_calibration,
)
from inhand_runtime.settings import FilePath, Section, Settings, load_settings
from inhand_runtime.source import SourceError
from inhand_schemas.messages import Pose


class LensOptions(Section):
    """The options of a source of this test."""

    file: FilePath
    serial: str | None = None
    gain: int = 1


class LensSource:
    """Says what its options are, and is never opened here."""

    options_model = LensOptions

    @staticmethod
    def check_options(options: Mapping[str, Any]) -> None:
        if options.get("gain", 1) > 9:
            raise SourceError("no lens has a gain above 9")


@pytest.fixture(autouse=True)
def _installed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(service, "require_source", lambda _: None)
    monkeypatch.setattr(service, "source_factory", lambda _: LensSource)


def checked(tmp_path: Path, options: str) -> Mapping[str, Any]:
    config = tmp_path / "rig.toml"
    config.write_text(f'[capture.front]\nsource = "lens"\n[capture.front.options]\n{options}\n')
    return service.check(load_settings(config, "capture", service.CaptureSettings))


def test_a_source_gets_its_options_as_checked(tmp_path: Path) -> None:
    assert checked(tmp_path, 'file = "a.yaml"') == {"file": tmp_path / "a.yaml"}


def test_digits_in_the_environment_are_text_or_a_number_as_the_source_wants(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("INHAND_CAPTURE__FRONT__OPTIONS__SERIAL", "0042")
    monkeypatch.setenv("INHAND_CAPTURE__FRONT__OPTIONS__GAIN", "3")
    options = checked(tmp_path, 'file = "/a.yaml"')
    assert options == {"file": Path("/a.yaml"), "serial": "0042", "gain": 3}


@pytest.mark.parametrize(
    ("options", "line"),
    [
        (
            'file = "a"\ngian = 2',
            "rig.toml:5: unknown setting capture.front.options.gian (did you mean gain?)",
        ),
        ("gain = 2", "rig.toml:3: setting capture.front.options.file is missing"),
        (
            'file = "a"\ngain = 10',
            "rig.toml:3: setting capture.front.options: no lens has a gain above 9",
        ),
    ],
)
def test_options_that_cannot_work_are_refused_with_their_line(
    tmp_path: Path, options: str, line: str
) -> None:
    with pytest.raises(SettingsError) as refused:
        checked(tmp_path, options)
    assert str(refused.value) == f"{tmp_path}/{line}"


def calibrated(tmp_path: Path, camera: str = "front") -> tuple[Path, CameraCalibration]:
    """Write a calibration that names one camera."""
    place = Pose((1.0, 2.0, 3.0), (0.0, 1.0, 0.0, 0.0))
    made = datetime(2026, 11, 30, tzinfo=UTC)
    one = CameraCalibration(place, (0.001,) * 3, (0.0001,) * 3, "board", made)
    path = tmp_path / "cameras.toml"
    write_rig_calibration(path, RigCalibration({camera: one}))
    return path, one


def settings_with(tmp_path: Path, calibration: str) -> Settings[service.CaptureSettings]:
    config = tmp_path / "rig.toml"
    config.write_text(
        f'[capture.front]\nsource = "lens"\ncalibration = "{calibration}"\n'
        '[capture.front.options]\nfile = "a.yaml"\n'
    )
    return load_settings(config, "capture", service.CaptureSettings)


def test_a_camera_has_its_place_from_the_calibration_beside_the_settings(tmp_path: Path) -> None:
    path, one = calibrated(tmp_path)
    settings = settings_with(tmp_path, path.name)
    service.check(settings)
    assert service.rig_from_camera(settings) == one.rig_from_camera


@pytest.mark.parametrize(
    ("camera", "file", "line"),
    [
        ("left", "cameras.toml", "does not calibrate the camera front (there are: left)"),
        ("front", "camras.toml", "cannot read"),
        ("front", "rig.toml", "unknown setting capture"),
    ],
)
def test_a_calibration_that_does_not_serve_the_camera_is_refused_before_a_start(
    tmp_path: Path, camera: str, file: str, line: str
) -> None:
    calibrated(tmp_path, camera)
    with pytest.raises(SettingsError) as error:
        service.check(settings_with(tmp_path, file))
    assert line in str(error.value)
    assert "rig.toml:3: setting capture.front.calibration: " in str(error.value)
