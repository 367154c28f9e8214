"""What `inhand install` puts into a system, and that it takes away exactly that."""

import sys
from pathlib import Path

import pytest

from inhand.__main__ import main
from inhand.deployment import deployed_files, program
from inhand.installation import RECORD

UNIT = "etc/systemd/system/inhand-up.service"


def _files(root: Path) -> dict[str, str]:
    return {
        path.relative_to(root).as_posix(): path.read_text()
        for path in root.rglob("*")
        if path.is_file()
    }


def _install(root: Path, *more: str) -> int:
    return main(["install", "--root", str(root), *more])


def test_what_is_printed_is_what_is_put_there(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert _install(tmp_path, "--print") == 0
    printed = capsys.readouterr().out
    assert _files(tmp_path) == {}
    assert _install(tmp_path) == 0
    there = _files(tmp_path)
    assert there.keys() == {*deployed_files(program()), RECORD}
    for place, text in there.items():
        if place != RECORD:
            assert f"# {tmp_path / place}\n{text}" in printed
    assert f"ExecStart={Path(sys.executable).parent}/inhand up " in there[UNIT]
    assert oct((tmp_path / UNIT).stat().st_mode)[-3:] == "644"


def test_units_that_run_what_is_not_in_the_system_are_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    command = program().split()[0]
    assert _install(tmp_path) == 0
    assert f"its units run {command}, which is not in {tmp_path}" in capsys.readouterr().err
    there = tmp_path / command.lstrip("/")
    there.parent.mkdir(parents=True)
    there.touch()
    assert _install(tmp_path) == 0
    assert capsys.readouterr().err == ""


def test_uninstall_removes_exactly_what_was_put_there(tmp_path: Path) -> None:
    other = tmp_path / "etc/systemd/system/other.service"
    other.parent.mkdir(parents=True)
    other.write_text("somebody else's")
    (tmp_path / "etc/udev").mkdir()
    before = sorted(tmp_path.rglob("*"))
    assert _install(tmp_path) == 0
    assert _install(tmp_path) == 0
    assert _install(tmp_path, "--uninstall") == 0
    assert sorted(tmp_path.rglob("*")) == before
    assert other.read_text() == "somebody else's"


def test_settings_of_the_user_stay(tmp_path: Path) -> None:
    _install(tmp_path)
    settings = tmp_path / "etc/inhand/rig.toml"
    settings.write_text('rig = "kitchen"\n')
    assert _install(tmp_path, "--uninstall") == 0
    assert _files(tmp_path) == {"etc/inhand/rig.toml": 'rig = "kitchen"\n'}


def test_a_file_of_somebody_else_is_not_written_over(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    unit = tmp_path / UNIT
    unit.parent.mkdir(parents=True)
    unit.write_text("mine")
    assert _install(tmp_path) == 1
    assert f"{unit} was not put there" in capsys.readouterr().err
    assert _files(tmp_path) == {UNIT: "mine"}


def test_a_unit_that_was_changed_is_neither_written_over_nor_removed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    _install(tmp_path)
    (tmp_path / UNIT).write_text("mine now")
    assert _install(tmp_path) == 1
    assert _install(tmp_path, "--uninstall") == 0
    assert f"left {tmp_path / UNIT}" in capsys.readouterr().err
    assert _files(tmp_path) == {UNIT: "mine now"}


def test_another_release_replaces_the_files_of_the_former_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    former = {**deployed_files("/opt/old/inhand"), "etc/systemd/system/inhand-old.service": "old"}
    monkeypatch.setattr("inhand.install.deployed_files", lambda _: former)
    assert _install(tmp_path) == 0
    monkeypatch.undo()
    assert _install(tmp_path) == 0
    assert _files(tmp_path).keys() == {*deployed_files(program()), RECORD}
    assert "/opt/old" not in (tmp_path / UNIT).read_text()


@pytest.mark.parametrize("text", ["{", '{"files": {"../../x": "0"}, "folders": []}'])
def test_a_record_that_is_none_changes_nothing(tmp_path: Path, text: str) -> None:
    _install(tmp_path)
    (tmp_path / RECORD).write_text(text)
    before = _files(tmp_path)
    assert _install(tmp_path, "--uninstall") == 1
    assert _files(tmp_path) == before


def test_who_may_not_write_there_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "etc").write_text("no folder")
    assert _install(tmp_path) == 1
    assert "run it as root" in capsys.readouterr().err


def test_units_of_a_home_are_refused_for_the_system(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("inhand.install.program", lambda: "/home/anna/venv/bin/inhand")
    assert main(["install"]) == 2
    assert "units may not look into homes" in capsys.readouterr().err
