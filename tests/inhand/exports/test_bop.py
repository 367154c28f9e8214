"""A BOP data set: masks and visibility by hand, and our reader of BOP finds the recording's."""

import json
from pathlib import Path

import cv2
import numpy as np
import pytest
import trimesh
from exported import export
from inhand_lab.importers.bop_models import read_bop_shape
from inhand_lab.importers.bop_scenes import read_scenes
from inhand_recorder.conversion import Selection
from inhand_runtime.errors import InhandError
from inhand_runtime.recording import RecordingError
from inhand_schemas.messages import Pose
from inhand_tracker.geometry.camera import Intrinsics
from small_rig import FRAME_NS, START_NS, colour_of, depth_of, pose_of, write_rig

from inhand.exports.bop import export_bop
from inhand.exports.bop_masks import mask_object
from inhand.exports.placed_objects import Mesh

CUBE = trimesh.creation.box((0.1, 0.1, 0.1))
MESH = Mesh(np.asarray(CUBE.vertices), np.asarray(CUBE.faces))
LENS = Intrinsics(200.0, 200.0, 32.0, 24.0, 64, 48)
AHEAD = (1.0, 0.0, 0.0, 0.0)


@pytest.fixture
def objects(tmp_path: Path) -> Path:
    """A folder with a mug that is a cube of 8 cm, with a quarter turn and a whole axis."""
    folder = tmp_path / "objects/mug"
    folder.mkdir(parents=True)
    trimesh.creation.box((0.08, 0.08, 0.08)).export(folder / "mesh.ply")
    (folder / "object.toml").write_text(
        "marked_vertices = [[0.04, 0.04, 0.04], [-0.04, 0.04, 0.04], [0.04, -0.04, 0.04]]\n"
        "[[symmetries]]\naxis = [0, 0, 2]\ncentre = [0.01, 0, 0]\norder = 4\n"
        "[[symmetries]]\naxis = [0, 1, 0]\norder = 0\n"
    )
    return tmp_path / "objects"


def test_a_surface_before_the_object_hides_it_and_a_hole_in_the_depth_does_not() -> None:
    # The front, 0.95 m away, covers 200 × 0.05 / 0.95 = 10.5 pixels on each side of (32, 24).
    pose = Pose((0.0, 0.0, 1.0), AHEAD)
    depth_m = np.full((48, 64), 0.95, np.float32)
    depth_m[:, :32] = 0.5
    depth_m[:20, :32] = 0.0
    depth_m[:, 40:] = 0.94
    masks = mask_object(MESH, pose, LENS, depth_m)
    assert masks.whole_pixels == np.count_nonzero(masks.silhouette) == 21 * 21
    assert masks.whole_box == (22, 14, 20, 20)
    np.testing.assert_array_equal(np.flatnonzero(masks.silhouette[24]), np.arange(22, 43))
    np.testing.assert_array_equal(np.flatnonzero(masks.visible[30]), np.arange(32, 43))
    np.testing.assert_array_equal(np.flatnonzero(masks.visible[15]), np.arange(22, 43))
    assert masks.visible_box == (22, 14, 20, 20)
    assert mask_object(MESH, pose, LENS, None).visible.sum() == 21 * 21


def test_what_is_beyond_the_image_counts_in_the_whole() -> None:
    masks = mask_object(MESH, Pose((-0.152, 0.0, 0.95), AHEAD), LENS, None)
    assert masks.silhouette.sum() < masks.whole_pixels
    left, _, width, _ = masks.whole_box
    assert left < 0 < left + width
    behind = mask_object(MESH, Pose((0.0, 0.0, -1.0), AHEAD), LENS, None)
    assert (behind.whole_pixels, behind.whole_box) == (0, (-1, -1, -1, -1))


def test_our_reader_of_bop_finds_the_recording_s_figures(tmp_path: Path, objects: Path) -> None:
    out = tmp_path / "bop"
    counts = export(export_bop, write_rig(tmp_path / "one.mcap"), out, objects=objects)
    assert counts == {"frames": 10, "poses": 10, "frames left out": 0}
    (scene,) = read_scenes(out)
    times = json.loads((scene.folder / "scene_times.json").read_text())
    info = json.loads((scene.folder / "scene_gt_info.json").read_text())
    for number, frame in enumerate(scene.frames):
        assert times[str(number)] == START_NS + number * FRAME_NS
        assert (frame.camera.fx, frame.camera.cy, frame.camera.depth_scale) == (60.0, 23.5, 0.001)
        depth = cv2.imread(str(frame.depth), cv2.IMREAD_UNCHANGED)
        np.testing.assert_array_equal(depth, depth_of(number))
        assert cv2.imread(str(frame.colour)).shape == colour_of(number).shape
        (label,) = frame.labels
        pose = pose_of(number)
        np.testing.assert_allclose(label.translation, pose.translation, atol=1e-9)
        assert abs(label.rotation @ np.array(pose.rotation)) == pytest.approx(1.0, abs=1e-12)
        for kind, count in (("mask", "px_count_all"), ("mask_visib", "px_count_visib")):
            mask = cv2.imread(str(scene.folder / kind / f"{number:06}_000000.png"), -1)
            assert np.count_nonzero(mask == 255) == info[str(number)][0][count] > 0
        assert label.visible_fraction == pytest.approx(
            info[str(number)][0]["px_count_visib"] / info[str(number)][0]["px_count_all"]
        )


def test_models_are_millimetres_with_their_symmetries(tmp_path: Path, objects: Path) -> None:
    out = tmp_path / "bop"
    export(export_bop, write_rig(tmp_path / "one.mcap", frames=1), out, objects=objects)
    shape = read_bop_shape(out / "models", 1)
    assert shape is not None
    np.testing.assert_allclose(np.ptp(shape.vertices, axis=0), 0.08, atol=1e-9)
    whole, quarter = shape.symmetries
    assert (whole.order, quarter.order) == (0, 4)
    assert quarter.centre == pytest.approx((0.01, 0.0, 0.0), abs=1e-9)
    (about,) = json.loads((out / "models/models_info.json").read_text()).values()
    assert about["name"] == "mug"
    assert about["diameter"] == pytest.approx(80.0 * np.sqrt(3.0))


def test_without_mesh_or_pose_nothing_is_made(tmp_path: Path, objects: Path) -> None:
    path = write_rig(tmp_path / "one.mcap", frames=1)
    with pytest.raises(InhandError, match="the shape of mug is not known"):
        export(export_bop, path, tmp_path / "bop")
    chosen = Selection(exclude=("label/*", "pose/*"))
    with pytest.raises(RecordingError, match="no poses and no labels"):
        export(export_bop, path, tmp_path / "bop", chosen, objects=objects)
    assert not (tmp_path / "bop").exists()
