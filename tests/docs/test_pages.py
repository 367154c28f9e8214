"""What the pages say can be done as they say it."""

import importlib.metadata
import re
import tomllib
from pathlib import Path

import pytest
from inhand_capture.settings import CaptureSettings
from inhand_outcomes.settings import OutcomesSettings
from inhand_outcomes.uses import USES
from inhand_recorder.settings import RecorderSettings
from inhand_tracker.settings import TrackerSettings
from running_rig import ROOT, RunningRig
from small_rig import write_rig

from inhand.__main__ import main

PAGES = sorted((ROOT / "docs").glob("*.md"))


def blocks(page: str, language: str) -> list[str]:
    """The fenced blocks of a page that are in a language."""
    text = (ROOT / "docs" / page).read_text()
    return re.findall(rf"^```{language}\n(.*?)^```", text, re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_no_page_speaks_of_a_release_that_is_not_there(page: Path) -> None:
    newest = tuple(map(int, importlib.metadata.version("inhand").split(".")))[:2]
    named = re.findall(r"[Rr]elease (\d+)\.(\d+)", page.read_text())
    assert all((int(major), int(minor)) <= newest for major, minor in named)


def test_the_recorders_page_shows_what_is_so_without_a_word() -> None:
    (text,) = blocks("recorder.md", "toml")
    defaults = RecorderSettings()
    for name, value in tomllib.loads(text)["recorder"]["disk"].items():
        line = next(line for line in text.splitlines() if line.startswith(f"{name} ="))
        if "(the default)" in line and "0 = never (the default)" not in line:
            assert getattr(defaults, name) == value
    assert defaults.split_seconds == 3600
    assert defaults.split_bytes == 0


def test_the_tutorials_rig_is_valid_and_follows_whom_the_model_does_not_know() -> None:
    (text,) = blocks("tutorial.md", "toml")
    rig = tomllib.loads(text)
    followed = rig["capture"]["front"]["options"]["participant"]
    page = (ROOT / "docs/tutorial.md").read_text()
    assert f"inhand train people --without p{followed:02} " in page
    CaptureSettings(**rig["capture"]["front"])
    TrackerSettings(**rig["tracker"]["mug"])
    RecorderSettings(**rig["recorder"]["disk"])


def test_the_outcomes_page_shows_what_is_so_without_a_word() -> None:
    measured, swept, text = blocks("outcomes.md", "toml")
    (region,) = OutcomesSettings.model_validate(tomllib.loads(swept)["outcomes"]["home"]).regions
    assert region.name == "under_the_table"
    OutcomesSettings.model_validate(tomllib.loads(measured)["outcomes"]["kitchen"])
    table = tomllib.loads(text)["outcomes"]["home"]
    chosen, defaults = OutcomesSettings.model_validate(table), OutcomesSettings()
    assert len(chosen.rules.goals) == 3
    for name in table.keys() - {"goals"}:
        line = next(line for line in text.splitlines() if line.startswith(f"{name} ="))
        if "(the default)" in line:
            assert getattr(defaults, name) == getattr(chosen, name)


def test_the_outcomes_page_names_the_uses_that_there_are_with_what_teaches_them() -> None:
    page = (ROOT / "docs/outcomes.md").read_text()
    named = re.findall(r"^\| `(\w+)` \((\w+)\) \|", page, re.MULTILINE)
    assert dict(named) == {name: use.interaction for name, use in USES.items()}


def test_the_commands_of_the_hub_s_page_do_what_it_shows(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    page = (ROOT / "docs/hub.md").read_text()
    hub, member, guest = blocks("hub.md", "toml")
    printed = {}
    for line in re.findall(r"^inhand (hub (?:init|add|renew|revoke) .*)$", page, re.MULTILINE):
        assert main(line.split()) == 0
        printed[line] = capsys.readouterr().out
    added = printed["hub add camera front"]
    assert all(line in added for line in member.splitlines()[1:])
    added = printed["hub add viewer tom --password"]
    written = re.sub(r"tom\.[0-9a-f]{8}", "tom.1f0c2a97", added).replace(":7448", ":7449")
    assert all(line in written for line in guest.splitlines())
    made = printed["hub init site --realm home --rigs kitchen --hosts hub.local 192.168.1.10"]
    assert tomllib.loads(hub)["hub"]["hub"]["listen"][0] in made
    Path("hub.toml").write_text(hub)
    assert main(["hub", "--config", "hub.toml", "--check-config"]) == 0


@pytest.mark.long
def test_the_reader_of_formats_md_prints_poses_and_ends(rig: RunningRig) -> None:
    (program,) = blocks("formats.md", "python")
    for text in ("tcp/127.0.0.1:7447", "/kitchen/"):
        assert text in program
    program = program.replace("tcp/127.0.0.1:7447", rig.meeting).replace("/kitchen/", "/rig/")
    rig.publisher()
    rig.inhand("echo", "rgbd/front", "--config", rig.config)  # the publisher waits for readers
    reader = rig.python("-c", program)
    assert reader.wait() == 0, reader.stderr
    lines = reader.stdout.splitlines()
    assert len(lines) == 10
    assert all(line.startswith("mug ") for line in lines)


def test_the_programs_of_reading_md_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    write_rig(tmp_path / "recordings" / "a.mcap")
    write_rig(tmp_path / "recordings" / "b.mcap", first=10)
    monkeypatch.chdir(tmp_path)
    printed = []
    for program in blocks("reading.md", "python"):
        exec(compile(program, "reading.md", "exec"), {})
        printed.append(capsys.readouterr().out)
    counts, loop, pictures, times = printed
    assert counts.startswith("0.6 s, 81 messages\ninfo/front 1\nlabel/mug 20\n")
    assert len(loop.splitlines()) == 20 + 16
    assert pictures.startswith("(48, 64, 3) 60.0 ")
    assert times == "tracked (16, 3) 10\n"
