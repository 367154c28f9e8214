"""A replay that runs as a process is controlled from another one, and by keys on its terminal."""

import os
import pty
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from inhand_runtime.inbox import Received
from inhand_schemas.messages import Skeletons
from inhand_schemas.topics import LABEL, SKELETONS
from played import FRAME_NS, START_NS, entries, write
from running_rig import ROOT, Process, RunningRig, eventually
from wire import Wire

pytestmark = pytest.mark.long


def numbers(heard: list[Received]) -> list[int]:
    messages: list[Skeletons] = [SKELETONS.decode(one.payload) for one in heard]
    return [(message.time_ns - START_NS) // FRAME_NS for message in messages]


def test_another_process_steps_seeks_and_resumes_a_replay(wire: Wire, rig: RunningRig) -> None:
    skeletons, labels = wire.hear(SKELETONS), wire.hear(LABEL)
    recording = write(rig.folder / "hundred.mcap", entries(100))
    options = ("--paused", "--rate", "0", "--remap", "camera/kitchen=front")
    replay = rig.inhand(
        "replay", recording, *options, "--remap", "object/mug=cup", "--config", rig.config
    )
    replay.said("is up")

    def ask(*request: str) -> Process:
        return rig.done("playback", "front", *request, "--config", rig.config)

    eventually(
        "an open source", lambda: "0.000 of 1.980 s at rate 0, paused" in ask("status").stdout
    )
    ask("step")
    eventually("the first frame", lambda: numbers(skeletons) == [0])
    ask("seek", "1.9")
    eventually("the frame at 1.9 s", lambda: numbers(skeletons) == [0, 95])
    assert ask("seek").stderr == "inhand playback: front: seek needs a number\n"
    assert ask("resume").popen.returncode == 0
    assert replay.wait() == 0
    eventually("the rest", lambda: numbers(skeletons) == [0, *range(95, 100)])
    assert {one.key for one in skeletons} == {"inhand/@v1/rig/skeletons/front"}
    assert {one.key for one in labels} == {"inhand/@v1/rig/label/cup"}
    missed = rig.done("playback", "front", "pause", "--config", rig.config, "--seconds", "0.2")
    assert missed.popen.returncode == 1
    assert "front does not answer" in missed.stderr


@dataclass
class Terminal:
    """A replay on a terminal of its own."""

    popen: subprocess.Popen[bytes]
    descriptor: int

    def press(self, keys: bytes) -> None:
        os.write(self.descriptor, keys)


@pytest.fixture
def terminal(rig: RunningRig) -> Iterator[Terminal]:
    """A hundred frames, paused."""
    recording = write(rig.folder / "hundred.mcap", entries(100))
    arguments = ["replay", str(recording), "--paused", "--config", str(rig.config)]
    ours, theirs = pty.openpty()
    replay = subprocess.Popen(
        [sys.executable, "-m", "inhand", *arguments], cwd=ROOT, stdin=theirs, stdout=theirs,
        stderr=theirs, env=os.environ | {"TERM": "xterm"},
    )  # fmt: skip
    os.close(theirs)
    yield Terminal(replay, ours)
    replay.kill()
    replay.wait()
    os.close(ours)


def test_keys_step_pause_seek_and_end_a_replay(
    wire: Wire, rig: RunningRig, terminal: Terminal
) -> None:
    heard = wire.hear(SKELETONS)

    def status() -> str:
        return rig.done("playback", "kitchen", "status", "--config", rig.config).stdout

    eventually("an open source", lambda: "paused" in status())
    terminal.press(b".")
    eventually("the first frame", lambda: numbers(heard) == [0])
    terminal.press(b"\x1b[C")
    eventually("the end", lambda: numbers(heard) == [0, 99])
    terminal.press(b"\x1b[D")
    eventually("the begin", lambda: numbers(heard) == [0, 99, 0])
    terminal.press(b"\x1b[A")
    eventually("a double rate", lambda: "at rate 2, paused" in status())
    terminal.press(b" ")
    eventually("it to go on", lambda: len(heard) > 5)
    terminal.press(b" ")
    eventually("a pause", lambda: "paused" in status())
    terminal.press(b"q")
    assert terminal.popen.wait(30) == 0


def test_what_a_recording_of_nothing_says_is_one_line(tmp_path: Path, rig: RunningRig) -> None:
    path = write(tmp_path / "none.mcap", entries(0))
    done = rig.done("replay", path, "--config", rig.config)
    assert done.popen.returncode == 2
    (line,) = done.stderr.splitlines()
    assert f"{path} holds no frame, skeleton or label of camera 'kitchen'" in line
