"""``inhand recording export`` as it is called."""

import json
import sys
from pathlib import Path

import pytest
from inhand_runtime.recording import read_recording
from small_rig import write_rig

from inhand.__main__ import main


def test_it_says_what_was_written_and_what_was_damaged(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write_rig(tmp_path / "one.mcap")
    data = bytearray(path.read_bytes())
    payload = next(m.payload for m in read_recording(path, streams=("rgbd",)) if m.sequence == 3)
    data[data.index(payload) + len(payload) - 3] ^= 0xFF
    path.write_bytes(data)
    told, out = tmp_path / "told.json", tmp_path / "out"
    words = ["recording", "export", str(path), "--to", "tum", "-o", str(out), "--json", str(told)]
    assert main(words) == 0
    assert capsys.readouterr().out == (
        f"{out}: 9 frames, 9 poses, 0 damaged images\n  rgbd/front: 1 damaged message left out\n"
    )
    assert json.loads(told.read_text())["exported"]["damaged"] == {"rgbd/front": 1}
    assert main(words) == 1
    assert "exists already" in capsys.readouterr().err


def test_a_missing_extra_is_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write_rig(tmp_path / "one.mcap", frames=1)
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    monkeypatch.delitem(sys.modules, "inhand.exports.parquet", raising=False)
    assert (
        main(["recording", "export", str(path), "--to", "parquet", "-o", str(tmp_path / "o")]) == 2
    )
    said = capsys.readouterr().err
    assert said == "inhand recording: needs the extra 'export': pip install \"inhand[export]\"\n"
