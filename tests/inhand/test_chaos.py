"""Faults through the command line, on real processes."""

import json

import pytest
from running_rig import RunningRig


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
def test_a_killed_recorder_loses_what_it_was_away_for_and_nobody_else_ends(
    rig: RunningRig,
) -> None:
    result = rig.folder / "chaos.json"
    tried = rig.inhand("chaos", "--faults", "kill-recorder", "--json", result)
    tried.popen.wait(200.0)
    assert result.exists(), tried.stderr
    (seen,) = json.loads(result.read_text())["faults"].values()
    assert seen["died"] == []
    assert seen["frames"] > 100
    assert 0 < seen["unrecorded"] < seen["frames"]
    assert seen["unrecorded_before_s"] <= 1.0
    assert seen["back_s"] is not None


@pytest.mark.long
def test_malformed_messages_are_counted_and_nobody_ends_or_grows(rig: RunningRig) -> None:
    result = rig.folder / "chaos.json"
    tried = rig.inhand(
        "chaos", "--faults", "malformed", "--messages", "30000", "--json", str(result)
    )
    tried.popen.wait(200.0)
    assert result.exists(), tried.stderr
    (seen,) = json.loads(result.read_text())["faults"].values()
    assert seen["died"] == []
    assert seen["malformed"] > 10_000
    assert seen["grown_mb"] < 50.0
    assert seen["back_s"] is not None
