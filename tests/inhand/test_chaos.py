"""Faults through the command line, on real processes."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from inhand_lab.chaos import soak, trials
from inhand_lab.chaos.parameters import DEFAULT_CHAOS
from inhand_lab.demonstration import preparation
from running_rig import RunningRig

from inhand.__main__ import main


@pytest.fixture
def _few_people(monkeypatch: pytest.MonkeyPatch) -> None:
    """How well the tracker was taught, which takes as long as a fault, is not the point here."""
    few = replace(preparation.DEFAULT_DEMONSTRATION, trained_participants=3, trained_frames=120)
    monkeypatch.setattr(preparation, "DEFAULT_DEMONSTRATION", few)


def test_a_fault_that_there_is_not_is_refused_with_those_that_there_are(rig: RunningRig) -> None:
    refused = rig.done("chaos", "--faults", "earthquake")
    assert refused.popen.returncode == 2
    assert "no fault 'earthquake'" in refused.stderr
    assert "kill-tracker" in refused.stderr


@pytest.mark.parametrize("messages", ["0", "-1", "many"])
def test_a_flood_of_no_messages_is_refused(rig: RunningRig, messages: str) -> None:
    refused = rig.done("chaos", "--faults", "malformed", "--messages", messages)
    assert refused.popen.returncode == 2
    assert "--messages" in refused.stderr


@pytest.mark.long
@pytest.mark.usefixtures("_few_people")
@pytest.mark.exhaustive
def test_a_killed_recorder_loses_what_it_was_away_for_and_malformed_messages_are_counted(
    tmp_path: Path,
) -> None:
    result = tmp_path / "chaos.json"
    faults = "--faults", "kill-recorder", "malformed"
    # Whether poses are as fast again as promised is chance on a busy machine.
    main(["chaos", *faults, "--messages", "20000", "--json", str(result)])
    told = json.loads(result.read_text())["faults"]
    killed, flooded = told["kill-recorder"], told["malformed"]
    assert killed["frames"] > 100
    assert 0 < killed["unrecorded"] < killed["frames"]
    assert killed["unrecorded_before_s"] <= 1.0
    assert flooded["malformed"] > 7_000
    assert flooded["grown_mb"] < 50.0
    for seen in (killed, flooded):
        assert seen["died"] == []
        assert seen["back_s"] is not None


@pytest.mark.long
@pytest.mark.usefixtures("_few_people")
@pytest.mark.exhaustive
def test_a_soak_says_of_each_process_how_it_grew(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    soon = replace(DEFAULT_CHAOS, soak_every_s=1.0, well_s=1.0, watched_s=3.0, reading_s=0.2)
    monkeypatch.setattr(soak, "DEFAULT_CHAOS", soon)
    monkeypatch.setattr(trials, "DEFAULT_CHAOS", soon)
    result = tmp_path / "soak.json"
    # Whether so short a time shows growth is chance.
    main(["chaos", "--soak", "1", "--faults", "kill-recorder", "--json", str(result)])
    told = json.loads(result.read_text())
    assert {life["name"] for life in told["processes"]} == {
        *("capture", "tracker", "recorder", "hub"),
        *("up of capture", "up of tracker", "up of recorder"),
    }
    for life in told["processes"]:
        assert set(life["courses"]) == {"MB", "handles", "threads"}
    (fault,) = told["faults"]
    assert (fault["fault"], fault["died"]) == ("kill-recorder", [])
    assert "MB an hour" in capsys.readouterr().out
