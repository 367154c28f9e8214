"""Parts of a file are written one behind the other, however the system takes them."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from inhand_runtime.recording.part_file import PartFile

UNSHARED = ("unshare", "--map-root-user", "--mount", "sh", "-c")
OWN_DISK = 'mount -t tmpfs -o size=1m none "$0" && exec "$@"'
FILL_THE_DISK = """
import sys
from pathlib import Path
from inhand_runtime.recording.part_file import PartFile
folder = Path(sys.argv[1])
filler = folder / "filler"
filler.write_bytes(bytes(600_000))
def make_room():
    filler.unlink()
    return True
file = PartFile(folder / "walk", make_room=make_room)
parts = [bytes([number % 256]) * 1000 for number in range(900)]
file.write(*parts)
assert not filler.exists()
assert file.bytes_written == 900_000
assert file.part.read_bytes() == b"".join(parts)
"""


def test_more_parts_than_the_system_takes_at_once_are_all_written(tmp_path: Path) -> None:
    file = PartFile(tmp_path / "walk")
    parts = [bytes([number % 256]) * (number % 3) for number in range(5000)]
    file.write(*parts)
    file.write()
    file.publish()
    assert (tmp_path / "walk").read_bytes() == b"".join(parts)
    assert file.bytes_written == sum(map(len, parts))


def test_more_bytes_than_wait_for_a_sync_are_all_written(tmp_path: Path) -> None:
    file = PartFile(tmp_path / "walk")
    block = os.urandom(1 << 20)
    for _ in range(20):
        file.write(block)
    file.publish()
    assert (tmp_path / "walk").read_bytes() == 20 * block


def test_what_did_not_fit_goes_on_where_it_stopped_once_there_is_room(tmp_path: Path) -> None:
    if subprocess.run([*UNSHARED, OWN_DISK, tmp_path, "true"], capture_output=True).returncode:
        pytest.skip("this user may mount nothing, not even in a namespace of its own")
    command = (*UNSHARED, OWN_DISK, tmp_path, sys.executable, "-c", FILL_THE_DISK, tmp_path)
    subprocess.run(command, check=True)
