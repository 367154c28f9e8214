"""A recording without its camera's info gets it from another one."""

from pathlib import Path

import pytest
from inhand_recorder.attachments import attach_mesh, meshes_in, read_attachments
from inhand_recorder.missing_infos import add_infos
from inhand_recorder.verification import verify_recording
from inhand_runtime.recording import RecordingError, RecordingWriter, read_recording
from inhand_runtime.recording.copying import copy_message
from inhand_schemas.keys import Site
from inhand_schemas.topics import INFO, POSE
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


def test_meshes_and_what_could_not_be_read_stay_too(tmp_path: Path) -> None:
    whole = write(tmp_path / "whole.mcap", entries(3))
    lacking, output = tmp_path / "lacking.mcap", tmp_path / "out.mcap"
    kept = write(tmp_path / "kept.mcap", entries(4, without=(INFO,)))
    with RecordingWriter(lacking) as writer:
        for one in read_recording(kept):
            copy_message(writer, one)
        attach_mesh(writer, "mug", b"ply", 5)
        writer.write_apart(POSE.key(Site(), "mug"), b"\xc1", received_ns=10**18)
    add_infos(lacking, whole, output)
    assert meshes_in(read_attachments(output)) == {"mug": b"ply"}
    apart = [one for one in read_recording(output, apart=True) if one.apart]
    assert [(one.name, one.payload, one.received_ns) for one in apart] == [("mug", b"\xc1", 10**18)]


def test_what_lacks_nothing_or_finds_nothing_is_told(tmp_path: Path) -> None:
    whole = write(tmp_path / "whole.mcap", entries(3))
    lacking = write(tmp_path / "lacking.mcap", entries(3, without=(INFO,)))
    with pytest.raises(RecordingError, match="lacks no camera's info"):
        add_infos(whole, whole, tmp_path / "out.mcap")
    with pytest.raises(RecordingError, match="holds no info of kitchen: it has none"):
        add_infos(lacking, lacking, tmp_path / "out.mcap")
    assert not (tmp_path / "out.mcap").exists()
