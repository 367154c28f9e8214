"""What `inhand support` puts into its file, and what never gets there."""

import json
import tarfile
from pathlib import Path

import pytest
from plugins import install_plugins
from running_rig import RunningRig

from inhand.__main__ import main

PARTS = {"settings.json", "versions.json", "system.json", "health.json", "logs.txt"}
SECRETS = {
    "password": "correct-horse-battery",
    "environment": "staple-of-the-environment",
    "file": "words in a file",
    "source": "rtsp-password",
    "unknown": "pasted-into-the-wrong-line",
    "address": "hunter2",
    "member": "words of a hub's member",
    "key": "MC4CAQAwBQYDK2VwBCIEIA",
    "database": "words of a database",
    "broker": "words of a broker",
    "person": "Anneliese",
}
SETTINGS = f"""
[studio.desk]
password = "{SECRETS["password"]}"
[studio.wall]
password_file = "wall.password"
[capture.front]
source = "secret"
[capture.front.options]
end = "{SECRETS["source"]}"
[capture.back]
source = "replay"
options = {{ file = "a.mcap", camera = "back", url = "http://anna:{SECRETS["address"]}@cam/" }}
[outcomes.home]
password_file = "home.password"
people = {{ 0 = "{SECRETS["person"]}" }}
[outcomes.home.homeassistant]
host = "broker"
user = "inhand"
password_file = "broker.password"
[[outcomes.home.goals]]
person = "{SECRETS["person"]}"
[recorder.disk]
folder = "recordings"
tint = "{SECRETS["unknown"]}"
"""


def _support(folder: Path, *arguments: str | Path) -> dict[str, str]:
    """Run the verb; returns the texts of the parts by their names."""
    output = folder / "bundle.tar.gz"
    assert main(["support", "-o", str(output), *map(str, arguments)]) == 0
    assert oct(output.stat().st_mode)[-3:] == "600"
    return _parts(output)


def _parts(output: Path) -> dict[str, str]:
    with tarfile.open(output) as archive:
        members = archive.getmembers()
        assert len({Path(one.name).parent for one in members}) == 1
        read = [(one, archive.extractfile(one)) for one in members]
        return {Path(one.name).name: file.read().decode() for one, file in read if file}


def _journal_says(folder: Path, text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the system's journal be one of these lines."""
    (folder / "bin").mkdir()
    (folder / "lines").write_text(text)
    program = folder / "bin/journalctl"
    program.write_text(f'#!/bin/sh\ncat "{folder}/lines"\n')
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(folder / "bin"), prepend=":")


@pytest.mark.long
def test_it_works_with_nothing_running_and_says_so(
    rig: RunningRig, capsys: pytest.CaptureFixture[str]
) -> None:
    rig.configure('[recorder.disk]\nfolder = "disk"')
    parts = _support(rig.folder, "--config", rig.config)
    assert parts.keys() == PARTS
    printed = capsys.readouterr().out
    assert all(f"  {name} " in printed for name in PARTS)
    assert "nothing runs" in printed
    health = json.loads(parts["health.json"])
    assert health["instances"] == []
    assert health["problems"][0].startswith("recorder disk is missing")
    assert json.loads(parts["settings.json"])["settings"]["recorder.disk"] == {"folder": "disk"}
    assert json.loads(parts["versions.json"])["inhand"]
    assert json.loads(parts["system.json"])["cores"] >= 1


@pytest.mark.long
def test_no_secret_is_in_it_wherever_it_stood(
    rig: RunningRig, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    rig.configure(SETTINGS)
    member = '[zenoh]\npassword = "member.password"\n'
    rig.config.write_text(rig.config.read_text().replace("[zenoh]\n", member))
    (rig.folder / "member.password").write_text(SECRETS["member"] + "\n")
    (rig.folder / "home.password").write_text(SECRETS["database"] + "\n")
    (rig.folder / "broker.password").write_text(SECRETS["broker"] + "\n")
    (rig.folder / "wall.password").write_text(SECRETS["file"] + "\n")
    monkeypatch.setenv("INHAND_STUDIO__SHELF__PASSWORD", SECRETS["environment"])
    monkeypatch.syspath_prepend(install_plugins(rig.folder / "plugins"))
    lines = "".join(f"a fault that shows {secret}\n" for secret in SECRETS.values())
    lines += f"-----BEGIN PRIVATE KEY-----\n{SECRETS['key']}\n-----END PRIVATE KEY-----\nafter\n"
    lines = lines.replace(f"shows {SECRETS['key']}", "shows nothing")
    lines = lines.replace(f"shows {SECRETS['address']}", "shows nothing")
    lines += f"cannot open http://anna:{SECRETS['address']}@cam/\n"
    _journal_says(rig.folder, lines, monkeypatch)
    parts = _support(rig.folder, "--config", rig.config)
    printed = capsys.readouterr()
    whole = "".join((*parts.values(), printed.out, printed.err))
    assert [name for name, secret in SECRETS.items() if secret in whole] == []
    shown = json.loads(parts["settings.json"])
    assert shown["environment"] == ["INHAND_STUDIO__SHELF__PASSWORD"]
    assert shown["settings"]["studio.wall"] == {"password_file": "wall.password"}
    assert shown["settings"]["studio.shelf"] == {"password": "(left out)"}
    assert shown["settings"]["capture.front"] == {"source": "secret", "options": "(left out)"}
    assert shown["settings"]["capture.back"]["options"]["file"] == "a.mcap"
    assert parts["logs.txt"].count("a fault that shows") == len(SECRETS)
    assert parts["logs.txt"].endswith("after\ncannot open http://cam/\n")


@pytest.mark.long
def test_of_a_rig_that_runs_its_health_is_there_and_no_picture(rig: RunningRig) -> None:
    rig.configure('[recorder.disk]\nfolder = "disk"')
    rig.inhand("recorder", "--config", rig.config).said("recorder disk is up")
    rig.publisher("--frames", "5")
    parts = _support(rig.folder, "--config", rig.config)
    assert parts.keys() == PARTS
    (disk,) = json.loads(parts["health.json"])["instances"]
    assert (disk["service"], disk["health"]["instance"]) == ("recorder", "disk")
    received = [topic["received"] for topic in disk["health"]["topics"].values()]
    assert sum(received) > 0
    assert sum(map(len, parts.values())) < 100_000


@pytest.mark.long
@pytest.mark.parametrize(
    ("text", "said"),
    [("[recorder", "is no TOML"), ('[recorder.disk]\n[capture]\nx = "y"', "capture.x stands in")],
    ids=["no TOML", "wrong"],
)
def test_settings_that_are_wrong_are_told_and_not_a_reason_to_fail(
    tmp_path: Path, text: str, said: str
) -> None:
    config = tmp_path / "rig.toml"
    config.write_text(text)
    parts = _support(tmp_path, "--config", config)
    assert said in json.loads(parts["settings.json"])["wrong"]
    assert said in json.loads(parts["health.json"])["problems"][0]


def test_a_place_that_cannot_be_written_is_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["support", "-o", str(tmp_path)]) == 2
    assert "it is a folder; name a file" in capsys.readouterr().err
