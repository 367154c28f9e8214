"""Bodies and frames in, recorded poses out, over a hub, by three members of their own roles."""

import pytest
from examples import EXAMPLES
from hub_site import RIG, SITE, made_site, start_hub
from inhand_recorder.verification import verify_recording
from inhand_runtime.recording import read_recording
from inhand_schemas.messages import ObjectPose
from inhand_schemas.topics import POSE
from msgspec.structs import replace
from running_rig import ROOT, RunningRig, eventually

pytestmark = pytest.mark.long

MODEL = ROOT / "tests/tracker/golden/drinkFromMug.model"
FORGED = 424_242
"""The number of poses that nobody estimated."""


def test_poses_are_recorded_over_a_hub_whatever_another_camera_tries(rig: RunningRig) -> None:
    site = start_hub(rig, made_site(rig.folder / "site"))
    out = rig.folder / "out"
    daemons = {
        "recorder": site.config("disk", f'[recorder.disk]\nfolder = "{out}"'),
        "tracker": site.config("mug", f'[tracker.mug]\ncamera = "front"\nmodel = "{MODEL}"'),
        "capture": site.config(
            "front",
            '[capture.front]\nsource = "simulator"\nwait_for_reader_s = 60\n'
            "[capture.front.options]\nframe_rate = 10.0\nframes = 60",
        ),
    }
    # Under a supervisor, which hears of its child through the hub as well.
    recorder = rig.inhand("up", "--config", daemons["recorder"])
    others = [rig.inhand(name, "--config", daemons[name]) for name in ("tracker", "capture")]
    for process, name in zip((recorder, *others), ("disk", "mug", "front"), strict=True):
        process.said(f"{name} is up")
    with site.joined("back") as attacker, site.joined("anna") as viewer:
        pose = next(one for one in EXAMPLES if isinstance(one, ObjectPose))
        forged = POSE.encode(replace(pose, sequence=FORGED, object="mug", camera="front"))
        heard = viewer.hear(POSE)

        def came() -> bool:
            attacker.session.put(POSE.key(SITE, "mug"), forged, encoding=POSE.encoding)
            return len(heard) >= 20

        eventually("20 poses", came)
    status = rig.done("status", "--config", site.config("anna"), "--seconds", "10")
    assert status.popen.returncode == 0, status.stdout + status.stderr
    for instance in ("capture front", "hub hub", "recorder disk", "tracker mug"):
        assert instance in status.stdout
    for process in (*reversed(others), recorder):
        assert process.stop() == 0, process.stderr
    (recording,) = out.glob("*.mcap")
    messages = [(one.key, one.message()) for one in read_recording(recording)]
    keys = {key.split("/", 3)[3] for key, _ in messages}
    assert keys >= {
        *(f"{stream}/front" for stream in ("info", "rgbd", "skeletons", "health")),
        *("pose/mug", "health/mug", "health/disk", "health/hub"),
    }
    assert all(key.startswith(f"home/@v1/{RIG}/") for key, _ in messages)
    poses = [message for _, message in messages if isinstance(message, ObjectPose)]
    assert len(poses) >= 20
    assert not [one for one in poses if one.sequence == FORGED]
    assert any(one.state == "tracked" for one in poses)
    assert verify_recording(recording) == []
