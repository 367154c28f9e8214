"""Depth as PNG, from a camera to all who read it."""

import numpy as np
import pytest
from inhand_lab.world.simulation import simulate
from inhand_runtime.pixels import decode_depth
from inhand_runtime.recording import read_recording
from inhand_schemas.messages import CameraInfo, RgbdFrame
from inhand_tracker.wire.conversion import image_of
from running_rig import RunningRig, eventually

pytestmark = pytest.mark.long
FRAMES = 20


def test_png_depth_is_recorded_verified_and_seen_by_the_tracker(rig: RunningRig) -> None:
    disk = rig.folder / "disk"
    rig.configure(
        '[capture.front]\nsource = "simulator"\ndepth_codec = "png16"\n'
        f"options = {{ loop = false, frames = {FRAMES} }}\n"
        f'[recorder.disk]\nfolder = "{disk}"\n'
    )
    recorder = rig.inhand("recorder", "--config", rig.config)
    recorder.said("is up")
    assert rig.inhand("capture", "--config", rig.config).wait() == 0
    key = "inhand/@v1/rig/rgbd/front"
    eventually("all frames", lambda: rig.counted("disk", key, "received") == FRAMES)
    assert recorder.stop() == 0
    (recording,) = disk.glob("*.mcap")
    for action in ("verify", "info"):
        looked = rig.done("recording", action, recording)
        assert looked.popen.returncode == 0, looked.stderr
    messages = [one.message() for one in read_recording(recording, streams=("info", "rgbd"))]
    (info,) = (one for one in messages if isinstance(one, CameraInfo))
    frames = [one for one in messages if isinstance(one, RgbdFrame)]
    assert [frame.sequence for frame in frames] == list(range(FRAMES))
    simulation = simulate("drinkFromMug", 0, seed=0, frames=FRAMES)
    for frame in frames:
        truth = simulation.render(frame.sequence).depth
        assert frame.depth is not None
        assert frame.depth.codec == "png16"
        np.testing.assert_array_equal(decode_depth(frame.depth), truth)
        image = image_of(frame, info, {"depth"})
        assert image is not None
        assert image.depth is not None
        np.testing.assert_allclose(image.depth, 0.001 * truth.astype(np.float32))
