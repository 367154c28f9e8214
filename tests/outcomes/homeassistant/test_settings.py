"""What a settings file may say of Home Assistant, and what is said of what it may not."""

import sys
from pathlib import Path

import pytest
from gated import certificate

from inhand.__main__ import main

TABLE = '[outcomes.home]\n[outcomes.home.homeassistant]\nhost = "broker"\n'


def checked(folder: Path, more: str, capsys: pytest.CaptureFixture[str]) -> tuple[int, str]:
    config = folder / "rig.toml"
    config.write_text(TABLE + more)
    code = main(["outcomes", "--config", str(config), "--check-config"])
    said = capsys.readouterr()
    return code, said.out + said.err


def test_what_is_right_is_valid(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    made = certificate(tmp_path)
    (tmp_path / "secret").write_text("a password\n")
    more = f'user = "inhand"\npassword_file = "secret"\nauthority = "{made["certificate"].name}"\n'
    assert checked(tmp_path, more, capsys) == (0, "outcomes home: the settings are valid\n")


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ('password_file = "nowhere"\nuser = "inhand"\n', "nowhere: No such file"),
        ('password_file = "rig.toml"\n', "password_file needs user"),
        ('authority = "rig.toml"\n', "it holds no certificate (PEM)"),
        ('discovery_prefix = "home/#"\n', "discovery_prefix"),
        ("port = 0\n", "port"),
        ('passwort = "x"\n', "passwort"),
    ],
)
def test_what_cannot_work_is_said(
    more: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code, text = checked(tmp_path, more, capsys)
    assert code == 2
    assert said in text


def test_a_missing_library_is_said_with_the_extra(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "aiomqtt", None)
    code, text = checked(tmp_path, "", capsys)
    assert (code, "inhand[homeassistant]" in text) == (2, True)
