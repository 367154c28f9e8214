"""What cannot be written is refused before the work, and asking leaves nothing behind."""

from pathlib import Path

import pytest
from inhand_runtime.errors import SettingsError
from inhand_runtime.writable import require_writable_file, require_writable_folder


def test_asking_makes_nothing_and_changes_nothing(tmp_path: Path) -> None:
    kept = tmp_path / "kept"
    kept.write_text("as before")
    require_writable_file(kept)
    require_writable_file(tmp_path / "new/folders/file")
    require_writable_folder(tmp_path / "other/folders")
    assert [path.name for path in tmp_path.rglob("*")] == ["kept"]
    assert kept.read_text() == "as before"


@pytest.mark.parametrize(
    ("name", "line"),
    [
        (".", r"cannot write .*: it is a folder; name a file"),
        ("file/below", r"cannot write .*file/below: Not a directory; choose another file"),
        ("/proc/nowhere/file", r"cannot write /proc/nowhere/file: .*; choose another file"),
    ],
)
def test_a_file_that_cannot_be_written_is_refused(tmp_path: Path, name: str, line: str) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(SettingsError, match=line):
        require_writable_file(tmp_path / name)


def test_a_folder_that_cannot_be_written_to_is_refused() -> None:
    with pytest.raises(SettingsError, match=r"cannot write to /proc/nowhere: .*another folder"):
        require_writable_folder(Path("/proc/nowhere"))
