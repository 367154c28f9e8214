"""``inhand bench`` from the command line to its file, on sizes that take seconds."""

import json
import subprocess
from functools import partial
from pathlib import Path

import pytest
from inhand_lab.benchmarks import frame_times
from inhand_lab.benchmarks.dora_delay import DORA, why_not_measured
from inhand_lab.benchmarks.frame_stages import STAGES
from inhand_lab.benchmarks.parameters import (
    ComparisonParameters,
    FrameCostParameters,
    FramePeopleParameters,
    HubCostParameters,
    TransportParameters,
)
from inhand_lab.benchmarks.tracker_speed import measure_tracker
from inhand_lab.benchmarks.transport_ends import RAW_SHARED, WAYS

from inhand import bench
from inhand.__main__ import main

ROOT = Path(__file__).parents[2]
FEW = FramePeopleParameters(people=3, frames=30)
COMPARISON = ComparisonParameters(people=FEW, turns=2, first_frames=5)
FRAMES = FrameCostParameters(
    people=FEW, interactions=("drinkFromMug", "hammerNail"), object_counts=(1, 2), first_frames=5
)


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    """A checkout without an environment: the source that git knows, as it is in the work tree."""
    listed = subprocess.run(
        ["git", "-C", ROOT, "ls-files", "-z", "*.py"], capture_output=True, text=True, check=True
    )
    folder = tmp_path / "copy"
    for name in filter(None, listed.stdout.split("\0")):
        if (ROOT / name).exists():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_bytes((ROOT / name).read_bytes())
    return folder


@pytest.mark.long
@pytest.mark.exhaustive
def test_frames_are_compared_with_a_checkouts_in_turns(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(bench, "DEFAULT_COMPARISON", COMPARISON)
    result = tmp_path / "result.json"
    assert main(["bench", "tracker", "--against", str(ROOT), "--json", str(result)]) == 0
    cases = json.loads(result.read_text())["cases"]
    assert [case["case"] for case in cases] == list(frame_times.CASES)
    for case in cases:
        assert len(case["here_ms"]) == len(case["there_ms"]) == len(case["ratios"]) == 2
        assert min(case["here_ms"] + case["there_ms"]) > 0.0
    assert "times longer" in capsys.readouterr().out


@pytest.mark.long
def test_a_checkout_that_fails_is_one_line_that_says_why(
    copy: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(bench, "DEFAULT_COMPARISON", COMPARISON)
    (copy / "services/tracker/inhand_tracker/__init__.py").write_text("raise OSError('broken')\n")
    assert main(["bench", "tracker", "--against", str(copy)]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"inhand bench: {copy} cannot be measured: OSError: broken")


@pytest.mark.long
def test_the_trackers_frames_are_measured_by_stages_and_by_objects_and_people(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(bench, "measure_tracker", partial(measure_tracker, 0.05, [500]))
    monkeypatch.setattr(bench, "DEFAULT_FRAME_COST", FRAMES)
    result = tmp_path / "result.json"
    assert main(["bench", "tracker", "--json", str(result)]) == 0
    told = json.loads(result.read_text())
    frames = told["frames"]
    assert list(frames["seen"]["stages_us"]) == list(STAGES)
    assert min(frames["seen"]["stages_us"].values()) > 0.0
    assert frames["unseen"]["stages_us"]["search"] == 0.0
    assert {(c["people"], c["objects"]) for c in frames["watching"]} == {
        (people, objects) for people in (1, 2) for objects in (1, 2)
    }
    assert [cost["frames"] for cost in told["fusion"]] == [500]
    shown = capsys.readouterr().out
    assert all(stage in shown for stage in STAGES)
    assert "2 objects each" in shown


@pytest.mark.long
def test_delays_are_measured_by_every_way_and_of_dora_or_it_is_said_to_be_absent(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    few = TransportParameters(shown_frame=1, pairs=2, frames=20, first_frames=10)
    monkeypatch.setattr(bench, "DEFAULT_TRANSPORT", few)
    result = tmp_path / "result.json"
    assert main(["bench", "transport", "--json", str(result)]) == 0
    told = json.loads(result.read_text())
    absent = why_not_measured()
    assert [way["way"] for way in told["ways"]] == [*WAYS, *([] if absent else [DORA])]
    assert told["without_dora"] == absent
    for way in told["ways"]:
        assert way["sent"] == 20
        # Shared memory may lose all of them where little memory may be locked.
        if way["way"] != RAW_SHARED:
            assert 0.0 < way["p50_ms"] <= way["p99_ms"]
            assert len(way["ratios"]) == (1 if way["way"] == DORA else 2)
    shown = " ".join(capsys.readouterr().out.split())
    assert ("dora-rs was left out: dora" in shown) == (absent is not None)


@pytest.mark.long
@pytest.mark.exhaustive
def test_a_hub_is_measured_by_its_rigs_with_a_stuck_reader_and_beside_a_plain_router(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    few = HubCostParameters(rig_counts=(1, 2), stuck_rigs=2, warming_s=1.0, measured_s=1.0, pairs=1)
    monkeypatch.setattr(bench, "DEFAULT_HUB_COST", few)
    result = tmp_path / "result.json"
    assert main(["bench", "hub", "--json", str(result)]) == 0
    told = json.loads(result.read_text())
    assert [(one["rigs"], one["stuck"]) for one in told["rigs"]] == [
        (1, False),
        (2, False),
        (2, True),
    ]
    for one in told["rigs"]:
        assert one["hub_cores"] > 0.0
        assert set(one["delays"]) == {"rgbd", "pose"}
        assert all(0.0 < delay["p50_ms"] <= delay["p99_ms"] for delay in one["delays"].values())
    assert [(one["stream"], one["rigs"]) for one in told["security"]] == [
        ("rgbd", 2),
        ("pose", 2),
        ("rgbd", 1),
        ("pose", 1),
    ]
    assert min(one["ratio"] for one in told["security"]) > 0.0
    assert "TLS and access rules" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["tracker", "--against", "."], "is no checkout of this project"),
        (["training", "--against", "."], "--against is for tracker"),
    ],
)
def test_a_comparison_with_nothing_is_wrong_usage(
    arguments: list[str],
    line: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["bench", *arguments]) == 2
    assert line in capsys.readouterr().err
