"""A recording without its camera's info gets it from another one."""

from pathlib import Path

import pytest
from inhand_recorder.missing_infos import add_infos
from inhand_recorder.verification import verify_recording
from inhand_runtime.recording import RecordingError, read_recording
from inhand_schemas.topics import INFO
from played import CAMERA_INFO, entries, write


def test_the_info_comes_first_and_all_else_stays(tmp_path: Path) -> None:
    whole = write(tmp_path / "whole.mcap", entries(3))
    lacking = write(tmp_path / "lacking.mcap", entries(4, without=(INFO,)))
    assert any("have no camera info" in problem for problem in verify_recording(lacking))
    assert add_infos(lacking, whole, tmp_path / "out.mcap") == ("kitchen",)
    messages = list(read_recording(tmp_path / "out.mcap"))
    assert messages[0].message() == CAMERA_INFO
    rest = [(one.key, one.payload, one.received_ns) for one in messages[1:]]
    assert rest == [(one.key, one.payload, one.received_ns) for one in read_recording(lacking)]
    assert verify_recording(tmp_path / "out.mcap") == []


def test_what_lacks_nothing_or_finds_nothing_is_told(tmp_path: Path) -> None:
    whole = write(tmp_path / "whole.mcap", entries(3))
    lacking = write(tmp_path / "lacking.mcap", entries(3, without=(INFO,)))
    with pytest.raises(RecordingError, match="lacks no camera's info"):
        add_infos(whole, whole, tmp_path / "out.mcap")
    with pytest.raises(RecordingError, match="holds no info of kitchen: it has none"):
        add_infos(lacking, lacking, tmp_path / "out.mcap")
    assert not (tmp_path / "out.mcap").exists()
