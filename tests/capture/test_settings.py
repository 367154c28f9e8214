"""What can be known of a source before a start is checked before a start."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import inhand_capture.settings as service
import pytest
from inhand_runtime.errors import SettingsError
from inhand_runtime.settings import FilePath, Section, load_settings
from inhand_runtime.source import SourceError


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
