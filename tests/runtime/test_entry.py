"""Exit codes and lines of a daemon's command line."""

from pathlib import Path

import pytest
from inhand_runtime.entry import daemon_main
from inhand_runtime.errors import InhandError, SettingsError
from inhand_runtime.settings import FilePath, Section, Settings


class FastSettings(Section):
    """A daemon's settings."""

    speed: int = 1


def _unused(_settings: Settings[FastSettings]) -> None:
    raise AssertionError("must not run")


def test_a_daemon_runs_with_its_own_table(tmp_path: Path) -> None:
    config = tmp_path / "rig.toml"
    config.write_text("[tracker.first]\n[tracker.second]\nspeed = 7\n")
    seen: list[Settings[FastSettings]] = []
    code = daemon_main(
        "tracker", FastSettings, seen.append, ["--config", str(config), "--name", "second"]
    )
    assert code == 0
    assert [(each.instance, each.service.speed) for each in seen] == [("second", 7)]


def test_a_folder_of_the_command_line_goes_over_the_file_and_follows_the_current_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    class PlacedSettings(Section):
        place: FilePath = Path("usual")
        speed: int = 1

    monkeypatch.chdir(tmp_path)
    config = tmp_path / "rigs" / "rig.toml"
    config.parent.mkdir()
    config.write_text('[tracker.mug]\nplace = "of the file"\nspeed = 7\n')
    seen: list[Settings[PlacedSettings]] = []
    arguments = ["--config", str(config), "--place", "chosen"]
    code = daemon_main(
        "tracker", PlacedSettings, seen.append, arguments, folders={"place": "where it is"}
    )
    assert code == 0
    assert [(one.service.place, one.service.speed) for one in seen] == [(tmp_path / "chosen", 7)]


def test_check_config_starts_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    assert daemon_main("tracker", FastSettings, _unused, ["--check-config"]) == 0
    assert capsys.readouterr().out == "tracker tracker: the settings are valid\n"


def test_wrong_settings_are_one_line_and_code_2(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    config = tmp_path / "rig.toml"
    config.write_text("[tracker.first]\nsped = 7\n")
    assert daemon_main("tracker", FastSettings, _unused, ["--config", str(config)]) == 2
    assert capsys.readouterr().err == (
        f"tracker: {config}:2: unknown setting tracker.first.sped (did you mean speed?)\n"
    )


@pytest.mark.parametrize(("error", "code"), [(InhandError, 1), (SettingsError, 2)])
def test_a_fault_is_one_line_and_its_code(
    error: type[InhandError], code: int, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail(_settings: Settings[FastSettings]) -> None:
        raise error("no disk: mount one")

    assert daemon_main("tracker", FastSettings, fail, []) == code
    assert capsys.readouterr().err == "tracker: no disk: mount one\n"


def test_wrong_arguments_end_with_2(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        daemon_main("tracker", FastSettings, _unused, ["--confg", "x"])
    assert ended.value.code == 2
    assert "unrecognized arguments" in capsys.readouterr().err
