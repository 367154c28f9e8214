"""Scenes of BOP become recordings: our own exports exactly, and other people's layouts."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import inhand_recorder
import numpy as np
import pytest
import trimesh
from bop_data import instance, save_bop, save_json, save_models, save_scene
from exported import export
from inhand_lab.datasets.dataset import START_NS as ASSUMED_START_NS
from inhand_recorder.attachments import meshes_in
from inhand_recorder.verification import verify_recording
from inhand_runtime.recording import read_metadata
from inhand_tracker.geometry.rotations import rotate
from small_rig import CAMERA, DEPTH_SCALE, FRAME_NS, START_NS, depth_of, pose_of, write_rig

from inhand.__main__ import main
from inhand.exports.bop import export_bop

SCENE = "test/000001"


def bring(source: Path, output: Path, *more: str) -> int:
    return main(["recording", "import", str(source), "--from", "bop", "-o", str(output), *more])


@pytest.fixture
def exported(tmp_path: Path) -> Path:
    """Our export of a recording whose mug is a cube of 8 cm."""
    folder = tmp_path / "objects/mug"
    folder.mkdir(parents=True)
    trimesh.creation.box((0.08, 0.08, 0.08)).export(folder / "mesh.ply")
    path = write_rig(tmp_path / "one.mcap")
    export(export_bop, path, tmp_path / "bop", objects=tmp_path / "objects")
    return tmp_path / "bop"


def test_what_we_exported_comes_back_exactly(
    exported: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    back = tmp_path / "back.mcap"
    assert bring(exported, back, "--camera", "front") == 0
    assert capsys.readouterr().out == f"{back}: 1 info/front, 10 rgbd/front, 10 label/mug\n"
    assert verify_recording(back) == []
    about = read_metadata(back)["import"]
    assert (about["source"], about["scene"], about["times"]) == ("bop", "test_000001", "recorded")
    with inhand_recorder.open(tmp_path / "one.mcap") as first, inhand_recorder.open(back) as second:
        info = second.infos["front"]
        lens = (info.fx, info.fy, info.cx, info.cy, info.width, info.height)
        assert lens == (CAMERA.fx, CAMERA.fy, CAMERA.cx, CAMERA.cy, CAMERA.width, CAMERA.height)
        assert info.depth_scale == DEPTH_SCALE
        assert info.frame_rate == pytest.approx(30.0)
        pairs = zip(first["rgbd/front"], second["rgbd/front"], second["label/mug"], strict=True)
        for number, (was, frame, label) in enumerate(pairs):
            assert frame.time_ns == label.time_ns == START_NS + number * FRAME_NS
            np.testing.assert_array_equal(frame.depth, depth_of(number))
            # PNG has the pixels as they were decoded; coded again they differ by a JPEG's loss.
            assert np.abs(frame.colour.astype(int) - was.colour).mean() < 1.0
            pose, true = label.message.camera_from_object, pose_of(number)
            np.testing.assert_allclose(pose.translation, true.translation, rtol=0, atol=1e-15)
            assert abs(np.dot(pose.rotation, true.rotation)) == pytest.approx(1.0, abs=1e-14)
            assert label.message.camera == "front"
        mesh = meshes_in(second.attachments())["mug"]
    (tmp_path / "mug.ply").write_bytes(mesh)
    vertices = trimesh.load_mesh(tmp_path / "mug.ply").vertices
    np.testing.assert_allclose(np.ptp(vertices, axis=0), 0.08, atol=1e-8)


def test_a_recording_exported_again_after_its_import_is_the_same_data_set(
    exported: Path, tmp_path: Path
) -> None:
    assert bring(exported, tmp_path / "back.mcap", "--camera", "front") == 0
    export(export_bop, tmp_path / "back.mcap", tmp_path / "again")
    for name in ("scene_gt", "scene_gt_info", "scene_camera", "scene_times"):
        was, now = (
            json.loads((one / SCENE / f"{name}.json").read_text())
            for one in (exported, tmp_path / "again")
        )
        assert close(was, now), name
    for kind in ("depth", "mask", "mask_visib"):
        files = sorted(one.name for one in (exported / SCENE / kind).iterdir())
        assert files
        for name in files:
            was, now = (one / SCENE / kind / name for one in (exported, tmp_path / "again"))
            assert was.read_bytes() == now.read_bytes()


def close(one: Any, other: Any) -> bool:
    """Whether two values of JSON are the same but for the last digits of their fractions."""
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(close(one[key], other[key]) for key in one)
    if isinstance(one, list):
        return len(one) == len(other) and all(map(close, one, other))
    return one == other if isinstance(one, int) else bool(abs(one - other) < 1e-9)


def test_other_peoples_scenes_have_an_assumed_rate_and_their_models_attached(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    root = tmp_path / "lm"
    save_models(root / "models", (1,))
    truth = {n: [instance(), instance(5), instance()] for n in (3, 4, 7)}
    scene = save_scene(root / "test/000048", truth, depth_scale=0.1)
    save_json(scene / "scene_gt_info.json", {n: [{"visib_fract": 0.25}] * 3 for n in truth})
    (scene / "depth/000004.png").unlink()
    output = tmp_path / "out.mcap"
    assert bring(scene, output, "--frame-rate", "10") == 0
    said = capsys.readouterr()
    assert "BOP has no times: image n is taken to be the n-th at 10 Hz\n" in said.out
    assert "no model is there of: obj_000005\n" in said.out
    assert verify_recording(output) == []
    assert read_metadata(output)["import"]["times"] == "assumed at 10 Hz"
    with inhand_recorder.open(output) as recording:
        frames = list(recording["rgbd/camera"])
        times = [frame.time_ns - ASSUMED_START_NS for frame in frames]
        assert times == [0, 100_000_000, 400_000_000]
        assert frames[1].depth is None
        assert frames[0].depth_m[20, 40] == pytest.approx(0.95)
        assert set(meshes_in(recording.attachments())) == {"obj_000001", "obj_000001_2"}
        (first, *_) = recording["label/obj_000001_2"]
        assert first.message.visible_fraction == 0.25
        # The cube's corner (50, 50, 50) mm: bop_data has where it is, 1.05 m before the camera.
        pose = first.message.camera_from_object
        corner = rotate(np.array(pose.rotation), np.array([0.05, 0.05, 0.05])) + pose.translation
        np.testing.assert_allclose(corner, (0.0, 0.03, 1.05), atol=1e-9)


def test_a_scene_without_truth_or_depth_and_grey_of_sixteen_bits_is_read(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scene = save_scene(
        tmp_path / "itodd" / SCENE, {0: [], 1: []}, colour="gray/{:06}.tif", with_depth=False
    )
    (scene / "scene_gt.json").unlink()
    for number in range(2):  # a camera of 12 bits: 4080 is its white, 255 in 8 bits
        pixels = np.full((48, 64), 1600 * (1 + number), np.uint16)
        pixels[0, 0] = 4080
        cv2.imwrite(str(scene / f"gray/{number:06}.tif"), pixels)
    output = tmp_path / "out.mcap"
    assert bring(tmp_path / "itodd", output) == 0
    said = capsys.readouterr().out
    assert "colour has 12 bits, of which the upper 8 are taken\n" in said
    assert "it has no scene_gt.json: there are no labels\n" in said
    assert "it has no depth" in said
    with inhand_recorder.open(output) as recording:
        info = recording.infos["camera"]
        assert (info.has_colour, info.has_depth) == (True, False)
        for number, frame in enumerate(recording["rgbd/camera"]):
            assert np.median(frame.colour) == pytest.approx(100 * (1 + number), abs=2)


def test_a_jpeg_stays_as_it_is_and_damaged_images_are_counted(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scene = save_scene(
        tmp_path / "pbr" / SCENE, {n: [instance()] for n in range(4)}, colour="rgb/{:06}.jpg"
    )
    whole = (scene / "rgb/000000.jpg").read_bytes()
    (scene / "rgb/000001.jpg").write_bytes(whole[: len(whole) // 2])
    cv2.imwrite(str(scene / "depth/000002.png"), np.zeros((48, 64), np.uint8))
    cv2.imwrite(str(scene / "depth/000003.png"), np.zeros((24, 32), np.uint16))
    output = tmp_path / "out.mcap"
    assert bring(tmp_path / "pbr", output) == 0
    assert "3 frames left out; the first: " in capsys.readouterr().out
    with inhand_recorder.open(output) as recording:
        (frame,) = recording["rgbd/camera"]
        assert frame.message.colour.data == whole


def test_one_of_several_sensors_is_named_by_its_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for sensor in ("_photoneo", "_realsense"):
        image = ("gray" if sensor == "_photoneo" else "rgb") + sensor + "/{:06}.png"
        save_scene(tmp_path / SCENE, {0: [instance()]}, sensor=sensor, colour=image)
    output = tmp_path / "out.mcap"
    assert bring(tmp_path, output) == 1
    said = capsys.readouterr().err
    assert "2 scenes or sensors: name one, of test/000001/scene_camera_photoneo.json" in said
    assert bring(tmp_path / SCENE / "scene_camera_realsense.json", output) == 0
    assert read_metadata(output)["import"]["scene"] == "test_000001_realsense"


def change_lens(root: Path) -> None:
    path = root / SCENE / "scene_camera.json"
    cameras = json.loads(path.read_text())
    cameras["1"]["depth_scale"] = 1.0
    save_json(path, cameras)


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (change_lens, "has 2 cameras"),
        (lambda root: (root / SCENE / "scene_gt.json").write_text("{"), "not as BOP has it"),
        (lambda root: (root / SCENE / "scene_camera.json").unlink(), "is no scene of BOP"),
        (lambda root: save_json(root / SCENE / "scene_times.json", {0: 5}), "has no image 1"),
        (lambda root: save_json(root / SCENE / "scene_times.json", {0: 5, 1: 5}), "must rise"),
        (lambda root: (root / "models/obj_000001.ply").write_bytes(b"ply\n"), "no mesh that can"),
        (
            lambda root: save_json(root / "models/models_info.json", {1: {"diameter": 0.17}}),
            "both are millimetres",
        ),
        (
            lambda root: [one.write_bytes(b"") for one in root.glob("test/*/rgb/*.png")],
            "no frame of it can be read: ",
        ),
    ],
)
def test_what_is_wrong_is_said_and_nothing_is_made(
    spoil: Callable[[Path], Any],
    said: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    root = save_bop(tmp_path / "in")
    save_scene(root / SCENE, {n: [instance()] for n in range(2)})
    spoil(root)
    assert bring(root, tmp_path / "out.mcap") == 1
    assert said in capsys.readouterr().err
    assert [one.name for one in tmp_path.iterdir()] == ["in"]


def test_options_of_other_formats_are_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    root, output = save_bop(tmp_path / "in"), tmp_path / "out.mcap"
    for more, said in (
        (("--object", "mug"), "--object says nothing about --from bop"),
        (("--camera-info", "/info"), "--camera-info says nothing about --from bop"),
        (("--frame-rate", "0"), "no camera has this rate"),
    ):
        assert bring(root, output, *more) != 0
        assert said in capsys.readouterr().err
    assert not output.exists()
