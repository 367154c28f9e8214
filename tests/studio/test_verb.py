"""A verb in a process of its own."""

import signal
import subprocess
import sys
from pathlib import Path

import pytest
from inhand_runtime.exit_codes import WRONG_USAGE
from inhand_studio.verb import Verb
from running_rig import eventually

STARTS_ANOTHER = """
import subprocess
from inhand_studio.bound_verb import end_with
print(subprocess.Popen(["sleep", "60"]).pid, flush=True)
end_with(0, 15)  # whose parent is gone
"""


def _lives(pid: int) -> bool:
    """Whether a process lives, and is not only waited for."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


def test_a_verb_and_what_it_started_end_with_the_parent() -> None:
    command = [sys.executable, "-c", STARTS_ANOTHER]
    with subprocess.Popen(command, stdout=subprocess.PIPE, process_group=0) as started:
        assert started.stdout is not None
        other = int(started.stdout.readline())
    assert started.returncode == -signal.SIGTERM
    eventually("the end of the other", lambda: not _lives(other))


@pytest.mark.long
def test_a_verb_that_fails_says_why_and_its_code() -> None:
    verb = Verb(["record", "--participant=Ada"])
    eventually("its end", lambda: verb.ended(1.0))
    assert verb.code == WRONG_USAGE
    assert "--dataset" in verb.lines[-1]
    verb.end()
