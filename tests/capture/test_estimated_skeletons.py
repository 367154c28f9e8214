"""Skeletons from pictures together with all that else is done to pictures: turned, masked, shut."""

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest
from drawn_heads import head_pixels
from fetched_weights import use_weights
from inhand_lab.world.simulation import simulate
from inhand_runtime.inbox import Received
from inhand_runtime.pixels import decode_colour, decode_depth
from inhand_schemas.messages import CameraInfo, ObjectPose, RgbdFrame, Skeletons
from inhand_schemas.topics import INFO, LABEL, PREVIEW, RGBD, SKELETONS
from running_rig import Process, RunningRig, eventually
from wire import Wire

pytestmark = pytest.mark.long
BLACK = 70
"""Brightest that JPEG makes a black pixel whose neighbours are not."""
LEFT = "masks = [[[0, 0], [0.2, 0], [0.2, 1], [0, 1]]]"
ALL = "masks = [[[0, 0], [1, 0], [1, 1], [0, 1]]]"

Start = Callable[[str, str], Process]


@pytest.fixture
def start(
    rig: RunningRig, plugin_folder: Path, own_data: Path, monkeypatch: pytest.MonkeyPatch
) -> Start:
    """Starts a capture that estimates, by a source and more lines of settings."""
    weights = use_weights(monkeypatch, "full", "faces")
    own_data.mkdir(exist_ok=True)
    if not (own_data / "models").exists():
        (own_data / "models").symlink_to(weights)
    monkeypatch.setenv("INHAND_DATA", str(own_data))

    def started(source: str, more: str) -> Process:
        rig.configure(f'[capture.front]\nsource = "{source}"\nskeletons = "estimated"\n{more}\n')
        arguments = ("-m", "inhand_capture", "--config", rig.config)
        return rig.python(*arguments, PYTHONPATH=str(plugin_folder))

    return started


def _largest_core_dump(process: Process) -> str:
    """Bytes of a core dump that the system would write at the most."""
    limits = Path(f"/proc/{process.pid}/limits").read_text().splitlines()
    return next(line for line in limits if line.startswith("Max core file size")).split()[4]


def _skeletons(heard: Sequence[Received]) -> list[Skeletons]:
    return [SKELETONS.decode(one.payload) for one in heard]


def _median_error(skeletons: Sequence[Skeletons], labels: Sequence[Received]) -> float:
    """Distance of joints from the truth, metres; each skeleton must be of one person."""
    decoded = [LABEL.decode(one.payload) for one in labels]
    truth = {one.sequence: one for one in decoded if isinstance(one, ObjectPose)}
    errors = []
    for one in skeletons:
        (person,) = one.people
        joints = truth[one.sequence].person_joints
        assert joints is not None
        errors.append(np.linalg.norm(np.array(person.joints) - joints, axis=1))
    return float(np.median(errors))


@pytest.mark.parametrize("degrees", [90, 180, 270])
def test_a_camera_that_hangs_has_skeletons_and_hidden_faces_as_one_that_stands(
    wire: Wire, rig: RunningRig, start: Start, degrees: int
) -> None:
    heard = {topic: wire.hear(topic) for topic in (INFO, RGBD, SKELETONS, LABEL)}
    options = f"options = {{ quarters = {4 - degrees // 90}, loop = false, frames = 45 }}"
    daemon = start("hanging", f"rotate = {degrees}\nmask_faces = true\n{options}")
    assert daemon.wait() == 0, daemon.stderr
    info = INFO.decode(heard[INFO][-1].payload)
    assert isinstance(info, CameraInfo)
    assert (info.width, info.height) == (640, 480)
    skeletons = _skeletons(heard[SKELETONS])
    assert len(skeletons) >= 5
    assert _median_error(skeletons, heard[LABEL]) < 0.06
    assert len(heard[RGBD]) == 45
    simulation = simulate("drinkFromMug", 0, seed=0, frames=45)
    for received in heard[RGBD]:
        frame = RGBD.decode(received.payload)
        assert frame.colour is not None
        assert frame.depth is not None
        head = head_pixels(simulation, frame.sequence)
        assert not decode_depth(frame.depth)[head].any()
        assert decode_colour(frame.colour)[head].max() < BLACK


def test_a_shutter_stops_estimated_skeletons_at_once_and_masks_hold_after_it(
    wire: Wire, rig: RunningRig, start: Start
) -> None:
    heard = {topic: wire.hear(topic) for topic in (RGBD, PREVIEW, SKELETONS, LABEL)}
    daemon = start("simulator", f"{LEFT}\nmask_faces = true")
    for _ in range(2):
        before = len(heard[SKELETONS])
        eventually("skeletons", lambda before=before: len(heard[SKELETONS]) >= before + 5)
        closed = rig.done("shutter", "close", "--config", rig.config)
        assert closed.popen.returncode == 0, closed.stderr
        counts = {topic: len(received) for topic, received in heard.items()}
        rig.health("front")  # a second at the least
        assert counts == {topic: len(received) for topic, received in heard.items()}
        assert _largest_core_dump(daemon) == "0"
        opened = rig.done("shutter", "open", "--config", rig.config)
        assert opened.popen.returncode == 0, opened.stderr
    assert daemon.stop() == 0
    skeletons = _skeletons(heard[SKELETONS])
    numbers = [one.sequence for one in skeletons]
    assert numbers == sorted(set(numbers))
    assert _median_error(skeletons, heard[LABEL]) < 0.06
    for received in heard[RGBD]:
        frame = RGBD.decode(received.payload)
        assert isinstance(frame, RgbdFrame)
        assert frame.colour is not None
        assert frame.depth is not None
        assert not decode_depth(frame.depth)[:, :128].any()
        assert decode_colour(frame.colour)[:, :120].max() < BLACK


def test_who_is_behind_a_mask_is_not_estimated(wire: Wire, rig: RunningRig, start: Start) -> None:
    skeletons, frames = wire.hear(SKELETONS), wire.hear(RGBD)
    daemon = start("simulator", f"{ALL}\noptions = {{ loop = false, frames = 30 }}")
    assert daemon.wait() == 0, daemon.stderr
    assert len(frames) == 30
    assert len(skeletons) >= 3
    assert all(one.people == () for one in _skeletons(skeletons))
