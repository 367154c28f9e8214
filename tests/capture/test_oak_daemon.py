"""The capture daemon with the OAK driver, whose sensors alone are stubbed, over real Zenoh."""

import itertools
from pathlib import Path

import numpy as np
import pytest
from inhand_runtime.inbox import Received
from inhand_runtime.pixels import decode_colour, decode_depth, encode_colour, encode_depth
from inhand_runtime.recording import RecordingWriter
from inhand_schemas.keys import Site
from inhand_schemas.messages import Health, RgbdFrame
from inhand_schemas.topics import HEALTH, INFO, RGBD
from running_rig import Process, RunningRig, eventually
from stub_oak import Shots
from wire import Wire


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    """Sixty pictures that show their number, recorded."""
    path = tmp_path / "shots.mcap"
    with RecordingWriter(path) as writer:
        for number, (colour, depth) in enumerate(Shots(60)):
            frame = RgbdFrame(
                sequence=number,
                time_ns=1_600_000_000_000_000_000 + number * 33_000_000,
                colour=encode_colour(colour),
                depth=encode_depth(depth),
            )
            writer.write(
                RGBD.key(Site(), "kitchen"),
                RGBD.encode(frame),
                received_ns=frame.time_ns,
                captured_ns=frame.time_ns,
                sequence=number,
            )
    return path


def _start(rig: RunningRig, plugins: Path, recording: Path, *script: str) -> Process:
    rig.configure(
        '[capture.front]\nsource = "stub_oak"\n[capture.front.options]\n'
        f'recording = "{recording}"\nscript = {list(script)!r}\n'
    )
    arguments = ("-m", "inhand_capture", "--config", rig.config)
    return rig.python(*arguments, PYTHONPATH=str(plugins))


def _healths(heard: list[Received]) -> list[Health]:
    return [HEALTH.decode(each.payload) for each in heard]


@pytest.mark.long
def test_colour_and_depth_of_one_moment_arrive_with_the_cameras_info(
    wire: Wire, rig: RunningRig, plugin_folder: Path, recording: Path
) -> None:
    heard, infos = wire.hear(RGBD), wire.hear(INFO)
    daemon = _start(rig, plugin_folder, recording, "play")
    eventually("twenty frames", lambda: len(heard) >= 20)
    frames = [RGBD.decode(each.payload) for each in heard]
    for frame in frames:
        assert frame.colour is not None
        assert frame.depth is not None
        red = int(np.median(decode_colour(frame.colour)[..., 0]))
        assert abs(red - (int(decode_depth(frame.depth)[0, 0]) - 1000)) <= 2
        assert 0 < frame.time_uncertainty_ns < 10_000_000
    for before, after in itertools.pairwise(frames):
        assert before.sequence < after.sequence
        assert before.time_ns < after.time_ns
    info = INFO.decode(infos[0].payload)
    assert (info.width, info.height, info.depth_scale) == (640, 480, 0.001)
    assert daemon.stop() == 0


@pytest.mark.long
@pytest.mark.parametrize(
    ("loss", "line"),
    [
        ("break", "the link to the camera broke"),
        ("crash", "the camera's firmware crashed"),
        ("silence", "no colour and no depth came for 2 s"),
    ],
)
def test_a_camera_that_is_lost_comes_back_and_its_sequence_goes_on(
    wire: Wire, rig: RunningRig, plugin_folder: Path, recording: Path, loss: str, line: str
) -> None:
    heard, health = wire.hear(RGBD), wire.hear(HEALTH)
    daemon = _start(rig, plugin_folder, recording, loss, "absent", "absent", "play")
    eventually(
        "the loss in health",
        lambda: any(line in text for one in _healths(health) for text in one.troubles),
    )
    daemon.said("source stub_oak is back; nothing was captured for")
    before = len(heard)
    eventually("frames after it", lambda: len(heard) > before + 10)
    frames = [RGBD.decode(each.payload) for each in heard]
    assert all(a.sequence < b.sequence for a, b in itertools.pairwise(frames))
    eventually("an end of the trouble", lambda: not _healths(health)[-1].troubles)
    assert _healths(health)[-1].state == "running"
    assert "no OAK camera is attached" not in daemon.stderr, "it was only restarting"
    assert daemon.stop() == 0


@pytest.mark.long
@pytest.mark.usefixtures("own_data")
def test_what_was_changed_while_it_ran_survives_a_loss(
    wire: Wire, rig: RunningRig, plugin_folder: Path, recording: Path
) -> None:
    heard = wire.hear(RGBD)
    daemon = _start(rig, plugin_folder, recording, "play")
    eventually("frames", lambda: len(heard) > 5)
    changed = rig.done("control", "front", "exposure_us=8000", "iso=400", "--config", rig.config)
    assert (changed.popen.returncode, changed.stdout) == (0, "front: done, until it ends\n")
    daemon.said("changed while it runs: {'exposure_us': 8000, 'iso': 400}")
    assert rig.done("shutter", "close", "--config", rig.config).popen.returncode == 0
    assert rig.done("shutter", "open", "--config", rig.config).popen.returncode == 0
    daemon.said("opened with exposure 8000")
    assert daemon.stop() == 0
