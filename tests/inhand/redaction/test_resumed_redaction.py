"""A redaction that was killed goes on, and gives what one without interruption gives."""

import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from inhand_runtime.errors import InhandError
from killed_redaction import PLACES, SECTION
from walked_past import told_finder, write_walk

from inhand.redaction.redacted import redact_recording

SCENES = Path(__file__).parents[2] / "scenes"


def redacted(
    path: Path, output: Path, step: str = "", number: int = 0
) -> subprocess.CompletedProcess[str]:
    """Redact in a process of its own, which kills itself at a step."""
    command = [sys.executable, str(SCENES / "killed_redaction.py"), str(path), str(output)]
    return subprocess.run(
        [*command, step, str(number)],
        env={"PYTHONPATH": str(SCENES)},
        stdout=subprocess.PIPE,
        text=True,
        timeout=120,
        check=False,
    )


@pytest.mark.long
def test_a_redaction_that_is_killed_goes_on_and_gives_the_same_bytes(tmp_path: Path) -> None:
    path = write_walk(tmp_path / "walk.mcap", PLACES * 3)
    whole, output = tmp_path / "whole" / "out.mcap", tmp_path / "out.mcap"
    whole.parent.mkdir()
    counts = redact_recording(
        [path], whole, "people", told_finder(PLACES), section_frames=SECTION
    ).counts
    for step, number in (("looking", 25), ("writing", 90)):
        assert redacted(path, output, step, number).returncode == -signal.SIGKILL
        assert not output.exists()
    folder = tmp_path / "out.mcap.redacting"
    names = sorted(one.name for one in folder.iterdir() if one.name.startswith("w"))
    assert names == ["written 0", "written 1", "written 2", "written 3"]
    process = redacted(path, output)
    assert process.returncode == 0
    messages = 1 + 4 * len(PLACES) * 3
    steps = {"looking": 3 * len(PLACES), "writing": messages}
    assert process.stdout == f"0 {steps} {dict(counts)}\n"
    assert output.read_bytes() == whole.read_bytes()
    assert sorted(one.name for one in tmp_path.iterdir()) == ["out.mcap", "walk.mcap", "whole"]


def test_what_was_done_of_other_files_or_in_another_way_is_not_taken(tmp_path: Path) -> None:
    path = write_walk(tmp_path / "walk.mcap", PLACES)
    output, folder = tmp_path / "out.mcap", tmp_path / "out.mcap.redacting"

    def interrupted(step: str, _total: int) -> None:
        if step == "writing":
            raise KeyboardInterrupt

    for what in ("people", "faces"):
        with pytest.raises(KeyboardInterrupt):
            redact_recording([path], output, what, told_finder(PLACES), interrupted, SECTION)
        assert [one.name[:6] for one in sorted(folder.iterdir())] == ["about.", "looked"]
        assert f'"hidden": "{what}"' in (folder / "about.json").read_text()
    (tmp_path / "other").mkdir()
    other = write_walk(tmp_path / "other" / "walk.mcap", [None] * SECTION)
    expected = redact_recording(
        [other], tmp_path / "expected.mcap", "faces", told_finder([None]), section_frames=SECTION
    )
    done = redact_recording([other], output, "faces", told_finder([None]), section_frames=SECTION)
    assert done.counts == expected.counts == {"frames": 10, "previews": 10, "frames all hidden": 10}
    assert not folder.exists()
    shutil.copytree(tmp_path / "other", folder)
    output.unlink()
    with pytest.raises(InhandError, match="is in the way: move it, or choose another name"):
        redact_recording([path], output, "faces", told_finder(PLACES))
    assert (folder / "walk.mcap").exists()
