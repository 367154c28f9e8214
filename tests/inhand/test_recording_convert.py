"""``inhand recording convert`` as it is called."""

import json
from datetime import UTC, datetime
from pathlib import Path

import pytest
from inhand_recorder.verification import verify_recording
from inhand_runtime.recording import read_recording
from small_rig import FRAME_NS, START_NS, write_rig

from inhand.__main__ import main


def _frames(path: Path) -> list[int]:
    return [one.sequence for one in read_recording(path, streams=("rgbd",))]


def test_a_folder_is_cut_by_seconds_and_by_the_clock(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for number in range(2):
        write_rig(tmp_path / "in" / f"{number}.mcap", first=15 * number, frames=15)
    told = tmp_path / "told.json"
    cut = tmp_path / "cut.mcap"
    words = ["recording", "convert", str(tmp_path / "in"), "-o"]
    end = datetime.fromtimestamp((START_NS + 20 * FRAME_NS) / 1e9, UTC).isoformat()
    asked = ["--start", "0.4", "--end", end, "--exclude", "health/*"]
    assert main([*words, str(cut), *asked]) == 1
    assert "there is no topic 'health/*'" in capsys.readouterr().err
    assert main([*words, str(cut), *asked[:-2], "--json", str(told)]) == 0
    assert verify_recording(cut) == []
    assert _frames(cut) == list(range(13, 20))
    assert json.loads(told.read_text())["converted"] == [{"path": str(cut), "messages": 33}]
    assert capsys.readouterr().out == f"{cut}: 33 messages\n"


def test_wrong_times_are_refused_before_anything_is_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write_rig(tmp_path / "one.mcap")
    words = ["recording", "convert", str(path), "-o", str(tmp_path / "out.mcap")]
    assert main([*words, "--start", "2", "--end", "1"]) == 2
    assert "--end is not behind --start" in capsys.readouterr().err
    for wrong in (["--start", "noon"], ["--end", "-1"], ["--split-seconds", "0"]):
        with pytest.raises(SystemExit, match="2"):
            main([*words, *wrong])
    assert not (tmp_path / "out.mcap").exists()
