"""Training recordings of a rig that runs."""

import json
import os
import resource
import signal
import time
from pathlib import Path

import pytest
from inhand_lab.datasets.dataset import load_dataset
from inhand_runtime.recording import read_recording
from running_rig import Process, RunningRig

CAMERA = '[capture.front]\nsource = "simulator"\nwait_for_reader_s = 0\n'


def _record(rig: RunningRig, folder: Path, *more: str | Path) -> Process:
    wanted = ("--participant", "Ada", "--interaction", "drinkFromMug", "--countdown", "1")
    return rig.inhand("record", "--config", rig.config, "--dataset", folder, *wanted, *more)


def _left(folder: Path) -> list[str]:
    return sorted(path.name for path in (folder / "recordings").glob("*"))


@pytest.mark.long
def test_takes_are_whole_and_in_the_dataset_or_nothing_of_them_is(
    rig: RunningRig, tmp_path: Path
) -> None:
    folder = tmp_path / "dataset"
    rig.configure(CAMERA)
    rig.inhand("capture", "--config", rig.config).said("is up")

    # Two at once: one that has no time while samples come, just before it begins, and one of a
    # left-handed person who ends it by Ctrl-C.
    told = tmp_path / "told.json"
    timed = _record(rig, folder, "--seconds", "2", "--json", told)
    stopped = _record(rig, folder, "--left-handed", "--participant", "Bob")
    timed.said("1 …")
    os.kill(timed.pid, signal.SIGSTOP)
    time.sleep(1.2)
    os.kill(timed.pid, signal.SIGCONT)
    stopped.said("until you stop it")
    assert timed.wait() == 0, timed.stderr
    assert stopped.stop(signal.SIGINT) == 0, stopped.stderr
    entries = load_dataset(folder).entries
    assert {(one.participant, one.handedness) for one in entries} == {
        ("Ada", "right"),
        ("Bob", "left"),
    }
    assert _left(folder) == sorted(Path(one.file).name for one in entries)
    result = json.loads(told.read_text())
    assert result["frames"] > 0
    assert result["missing"].keys() <= {"right hand", "left hand"}
    recording = Path(result["recording"])
    streams = [message.topic.stream for message in read_recording(recording)]
    assert streams[0] == "info"
    assert streams.count("rgbd") == result["frames"]
    assert streams.count("skeletons") == result["skeletons"]
    assert rig.done("recording", "verify", recording).popen.returncode == 0

    # Ctrl-C in the countdown, and a disk that is full in the middle.
    before = (folder / "dataset.toml").read_text(), _left(folder)
    early = _record(rig, folder, "--countdown", "60")
    early.said("59 …")
    assert early.stop(signal.SIGINT) == 130
    full = _record(rig, folder, "--countdown", "2")
    full.said("2 …")
    resource.prlimit(full.pid, resource.RLIMIT_FSIZE, (1 << 20, resource.RLIM_INFINITY))
    assert full.wait() == 1
    assert "nothing of this take was kept" in full.stderr
    assert ((folder / "dataset.toml").read_text(), _left(folder)) == before


@pytest.mark.long
def test_of_a_camera_that_shows_nothing_it_is_said_at_once_and_nothing_is_kept(
    rig: RunningRig, tmp_path: Path
) -> None:
    rig.publisher("--frames", "0")
    record = _record(rig, tmp_path, "--seconds", "2", "--countdown", "3")
    record.said("No picture comes")
    record.said("No skeletons come")
    assert record.wait() == 1
    assert "nothing was kept" in record.stderr
    assert _left(tmp_path) == []


@pytest.mark.long
def test_without_an_object_or_a_camera_it_is_said_before_anything_is_made(
    rig: RunningRig, tmp_path: Path
) -> None:
    done = _record(rig, tmp_path, "--object", "mugg")
    assert done.wait() == 2
    assert "inhand object new mugg" in done.stderr
    done = _record(rig, tmp_path)
    assert done.wait() == 1
    assert "nothing answered" in done.stderr
    assert not (tmp_path / "recordings").exists()
