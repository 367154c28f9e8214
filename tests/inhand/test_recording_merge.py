"""``inhand recording merge`` estimates the clocks of hosts, and says what it does not know."""

import json
from pathlib import Path

import pytest
from inhand_lab.datasets.dataset import START_NS
from inhand_lab.datasets.dataset_writer import write_received
from inhand_lab.datasets.generation import rig_messages
from inhand_lab.world.rigs import RigSimulation, simulate_rig
from inhand_recorder.verification import verify_recording
from inhand_runtime.recording import read_recording
from inhand_schemas.messages import ObjectPose
from msgspec import structs
from small_rig import write_rig

from inhand.__main__ import main

LATE_NS = 2_345_600_000
"""How far the second host's clock is ahead."""


def write_host(rig: RigSimulation, path: Path, cameras: set[str], ahead_ns: int) -> Path:
    """Write what the host of some cameras recorded, whose clock is ahead."""
    late = (
        (camera, received_ns + ahead_ns, structs.replace(one, time_ns=one.time_ns + ahead_ns))
        for camera, received_ns, one in rig_messages(rig, images=False)
        if (one.camera if isinstance(one, ObjectPose) else camera) in cameras
    )
    write_received(path, late)
    return path


@pytest.mark.long
def test_the_clock_of_another_host_is_estimated_from_people_within_5_ms(tmp_path: Path) -> None:
    rig = simulate_rig("drinkFromMug", 0, 8, frames=900, cameras=2, roaming=True)
    front = write_host(rig, tmp_path / "front.mcap", {"front"}, 0)
    left = write_host(rig, tmp_path / "left.mcap", {"left"}, LATE_NS)
    merged, result = tmp_path / "all.mcap", tmp_path / "all.json"
    command = ["recording", "merge", str(front), str(left), "-o", str(merged)]
    assert main([*command, "--json", str(result)]) == 0
    host = json.loads(result.read_text())["merged"]["hosts"]["left.mcap"]
    expected_ns = 1e9 * rig.clocks[1].offset_s - LATE_NS
    assert host["offset_ns"] == pytest.approx(expected_ns, abs=5e6)
    assert host["evidence"] == "people whom rig/left and rig/front saw"
    assert verify_recording(merged) == []
    received = [one.received_ns for one in read_recording(merged, streams=("skeletons",))]
    assert max(received) - min(received) < 31e9
    assert min(received) - START_NS < 1e9


def test_a_clock_that_nothing_tells_of_is_taken_as_it_is_and_that_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    one = write_rig(tmp_path / "one.mcap")
    rig = simulate_rig("drinkFromMug", 0, 8, frames=10, cameras=2)
    left = write_host(rig, tmp_path / "left.mcap", {"left"}, 0)
    merged = tmp_path / "all.mcap"
    assert main(["recording", "merge", str(one), str(left), "-o", str(merged)]) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "+0.0 ms: taken as it is, for nothing says how far it is off: " in said
    assert "followed nobody for two seconds" in said


def test_one_host_alone_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    one = write_rig(tmp_path / "one.mcap")
    assert main(["recording", "merge", str(one), "-o", str(tmp_path / "all.mcap")]) == 2
    assert "two hosts or more" in capsys.readouterr().err
