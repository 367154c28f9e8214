"""The capture daemon as a process over real Zenoh."""

from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest
from fetched_weights import use_weights
from inhand_runtime.inbox import Received
from inhand_runtime.rig_calibration import (
    CameraCalibration,
    RigCalibration,
    write_rig_calibration,
)
from inhand_schemas.messages import CameraInfo, Health, Message, ObjectPose, Pose, Skeletons
from inhand_schemas.topics import HEALTH, INFO, LABEL, RGBD, SKELETONS, AnyTopic
from played import FRAME_NS as RECORDED_FRAME_NS
from played import START_NS, entries, write
from running_rig import Process, RunningRig, eventually
from scripted_source import FIRST_NS, FRAME_NS
from wire import Wire


def _configure(rig: RunningRig, *script: int | str, more: str = "") -> None:
    rig.configure(
        f'[capture.front]\nsource = "scripted"\n{more}\n'
        f"[capture.front.options]\nscript = {list(script)!r}\n"
    )


@pytest.fixture
def capture(rig: RunningRig, plugin_folder: Path) -> "Start":
    """Starts the configured capture daemon."""
    return Start(rig, plugin_folder)


class Start:
    """Starts the daemon with the plugin on its path."""

    def __init__(self, rig: RunningRig, plugins: Path) -> None:
        self._rig = rig
        self._plugins = plugins

    def __call__(self, *arguments: str) -> Process:
        return self._rig.python(
            "-m", "inhand_capture", "--config", self._rig.config, *arguments,
            PYTHONPATH=str(self._plugins),
        )  # fmt: skip


def _decoded(topic: AnyTopic, heard: list[Received]) -> list[Message]:
    return [topic.decode(each.payload, each.encoding) for each in heard]


def _health(heard: list[Received]) -> Health | None:
    return HEALTH.decode(heard[-1].payload) if heard else None


def test_every_moment_arrives_and_the_daemon_ends_with_its_source(
    wire: Wire, rig: RunningRig, capture: Start
) -> None:
    topics: dict[AnyTopic, list[Received]] = {
        topic: wire.hear(topic) for topic in (SKELETONS, RGBD, LABEL)
    }
    infos = wire.hear(INFO)
    _configure(rig, 50)
    daemon = capture()
    assert daemon.wait() == 0
    assert "source scripted has come to its end" in daemon.stderr
    for topic, heard in topics.items():
        eventually(f"all of {topic.stream}", lambda heard=heard: len(heard) == 50)
        messages = _decoded(topic, heard)
        assert [message.sequence for message in messages] == list(range(50))
        assert [message.time_ns for message in messages] == [
            FIRST_NS + number * FRAME_NS for number in range(50)
        ]
    assert len(infos) == 1


def test_a_replay_repeats_the_recorded_moments_and_ends(
    wire: Wire, rig: RunningRig, capture: Start
) -> None:
    heard: dict[AnyTopic, list[Received]] = {t: wire.hear(t) for t in (SKELETONS, RGBD, LABEL)}
    recording = write(rig.folder / "ten.mcap", entries(10))
    rig.configure(
        f'[capture.front]\nsource = "replay"\n[capture.front.options]\nfile = "{recording}"\n'
    )
    assert capture().wait() == 0
    for topic, received in heard.items():
        eventually(f"all of {topic.stream}", lambda received=received: len(received) == 10)
        times = [message.time_ns for message in _decoded(topic, received)]
        assert times == [START_NS + number * RECORDED_FRAME_NS for number in range(10)]


def test_a_recording_that_was_cut_is_refused_before_a_start(
    rig: RunningRig, capture: Start
) -> None:
    recording = write(rig.folder / "ten.mcap", entries(10))
    recording.write_bytes(recording.read_bytes()[:2000])
    rig.configure(
        f'[capture.front]\nsource = "replay"\n[capture.front.options]\nfile = "{recording}"\n'
    )
    daemon = capture()
    assert daemon.wait() == 2
    assert daemon.stderr == (
        f"capture: {rig.config}:3: setting capture.front.options: {recording} was cut off: "
        f"`inhand recording recover {recording}` saves what is left\n"
    )


def test_info_reaches_those_who_come_late(wire: Wire, rig: RunningRig, capture: Start) -> None:
    _configure(rig, 1, "hang", more="wait_for_reader_s = 0")
    capture().said("is up")
    infos = wire.hear(INFO)
    eventually("the info", lambda: infos)


def test_the_camera_is_published_where_its_calibration_had_it_and_another_one_is_said(
    wire: Wire, rig: RunningRig, capture: Start
) -> None:
    place = Pose((1.0, 2.0, 3.0), (0.0, 1.0, 0.0, 0.0))
    made = datetime(2026, 11, 30, tzinfo=UTC)
    front = CameraCalibration(place, (0.001,) * 3, (0.0001,) * 3, "board", made)
    write_rig_calibration(rig.folder / "cameras.toml", RigCalibration({"front": front}))
    _configure(rig, 100_000, more='wait_for_reader_s = 0\ncalibration = "cameras.toml"')
    infos, health = wire.hear(INFO), wire.hear(HEALTH)
    capture().said("is up")
    eventually("the info", lambda: infos)
    (info,) = _decoded(INFO, infos[:1])
    assert isinstance(info, CameraInfo)
    assert info.rig_from_camera == place
    elsewhere = replace(front, rig_from_camera=Pose((1.0, 2.0, 3.5), place.rotation))
    write_rig_calibration(rig.folder / "cameras.toml", RigCalibration({"front": elsewhere}))
    said = eventually("a trouble", lambda: (h := _health(health)) and h.troubles)
    assert "cameras.toml was written anew" in said[0]


def test_a_source_starts_when_nobody_comes(rig: RunningRig, capture: Start) -> None:
    _configure(rig, 2, more="wait_for_reader_s = 0.1")
    assert capture().wait() == 0


def test_a_lost_camera_comes_back_and_its_sequence_goes_on(
    wire: Wire, rig: RunningRig, capture: Start
) -> None:
    skeletons, health = wire.hear(SKELETONS), wire.hear(HEALTH)
    _configure(rig, 5, "lost", "closed", "closed", 5, "hang")
    daemon = capture()
    eventually("a degraded state", lambda: (h := _health(health)) and h.state == "degraded")
    eventually("moments after it", lambda: len(skeletons) == 10)
    assert [message.sequence for message in _decoded(SKELETONS, skeletons)] == list(range(10))
    report = eventually("recovery", lambda: (h := _health(health)) and h.state == "running" and h)
    assert report.last_error == "source scripted: no scripted camera is connected"
    assert daemon.stop() == 0


def test_a_camera_that_is_not_there_ends_the_daemon_with_its_line(
    rig: RunningRig, capture: Start
) -> None:
    _configure(rig, "closed", 1)
    daemon = capture()
    assert daemon.wait() == 1
    last = daemon.stderr.splitlines()[-1]
    assert last == "capture: source scripted: no scripted camera is connected"
    assert "Traceback" not in daemon.stderr


def test_a_signal_ends_a_source_that_hangs(rig: RunningRig, capture: Start) -> None:
    _configure(rig, "hang", more="wait_for_reader_s = 0")
    daemon = capture()
    daemon.said("is up")
    assert daemon.stop() == 0


@pytest.mark.parametrize(
    ("settings", "line"),
    [
        (
            "",
            '[capture.capture]: no camera is configured: write [capture.front] with source = "oak" '
            'for a camera that `inhand capture --list` shows, source = "simulator", which needs '
            'none, or source = "replay" and the recording as options.file',
        ),
        (
            '[capture.front]\nsource = "kinect"\n',
            "setting capture.front.source: no source 'kinect' is installed; there are: ",
        ),
    ],
)
def test_a_camera_that_cannot_be_is_refused_by_check_config_too(
    rig: RunningRig, capture: Start, settings: str, line: str
) -> None:
    rig.configure(settings)
    for arguments in ((), ("--check-config",)):
        daemon = capture(*arguments)
        assert daemon.wait() == 2
        assert line in daemon.stderr
        assert daemon.stderr.count("\n") == 1


def test_a_source_whose_package_is_missing_says_what_to_install(
    rig: RunningRig, capture: Start
) -> None:
    rig.configure('[capture.front]\nsource = "unusable"\n')
    daemon = capture()
    assert daemon.wait() == 2
    assert (
        "needs the package package_that_nobody_has, which is not installed: "
        "run pip install 'inhand[unusable]'" in daemon.stderr
    )


@pytest.mark.long
def test_a_simulator_that_hides_its_skeleton_has_it_estimated_from_its_pictures(
    wire: Wire, rig: RunningRig, monkeypatch: pytest.MonkeyPatch
) -> None:
    use_weights(monkeypatch, "full")
    heard = {topic: wire.hear(topic) for topic in (RGBD, SKELETONS, LABEL)}
    rig.configure(
        '[capture.front]\nsource = "simulator"\nskeletons = "estimated"\n'
        "[capture.front.options]\nloop = false\nframes = 60\n"
    )
    assert rig.python("-m", "inhand_capture", "--config", rig.config).wait() == 0
    frames, skeletons, labels = (_decoded(topic, got) for topic, got in heard.items())
    times = {frame.sequence: frame.time_ns for frame in frames}
    assert list(times) == list(range(60))
    assert len(skeletons) >= 10
    numbers = [message.sequence for message in skeletons]
    assert numbers == sorted(set(numbers))
    for message in skeletons:
        assert isinstance(message, Skeletons)
        assert message.time_ns == times[message.sequence]
        (person,) = message.people
        label = labels[message.sequence]
        assert isinstance(label, ObjectPose)
        assert label.person_joints is not None
        off = np.linalg.norm(np.array(person.joints) - label.person_joints, axis=1)
        assert np.median(off) < 0.06


def test_estimated_skeletons_without_weights_are_refused_before_a_start(
    rig: RunningRig, tmp_path: Path
) -> None:
    rig.configure('[capture.front]\nsource = "simulator"\nskeletons = "estimated"\n')
    command = ("-m", "inhand_capture", "--config", rig.config, "--check-config")
    daemon = rig.python(*command, INHAND_DATA=str(tmp_path))
    assert daemon.wait() == 1
    assert daemon.stderr.startswith(f"capture: there are no weights at {tmp_path}/models/pose_")
    assert daemon.stderr.endswith("fetch them with `inhand models fetch`\n")


@pytest.mark.long
def test_faces_cannot_be_hidden_without_weights(
    rig: RunningRig, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = use_weights(monkeypatch, "full")
    (tmp_path / "models").mkdir()
    for file in folder.glob("pose_*"):
        (tmp_path / "models" / file.name).symlink_to(file)
    rig.configure('[capture.front]\nsource = "simulator"\nmask_faces = true\n')
    command = ("-m", "inhand_capture", "--config", rig.config, "--check-config")
    daemon = rig.python(*command, INHAND_DATA=str(tmp_path))
    assert daemon.wait() == 1
    assert daemon.stderr.startswith(f"capture: there are no weights at {tmp_path}/models/face_")
    assert daemon.stderr.endswith("fetch them with `inhand models fetch faces`\n")
