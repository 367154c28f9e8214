"""BOP data sets as datasets."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from bop_data import CORNERS, instance, save_bop, save_json, save_models, save_scene
from foreign_data import messages_of, only_entry
from inhand_lab.datasets.dataset import START_NS, Dataset, DatasetError, load_dataset
from inhand_lab.datasets.recorded_frames import load_camera
from inhand_lab.evaluation.pose_errors import least_angle
from inhand_lab.importers.bop import import_bop
from inhand_runtime.pixels import decode_colour, decode_depth
from inhand_runtime.recording import read_recording
from inhand_schemas.messages import CameraInfo, ObjectPose, RgbdFrame
from inhand_tracker.geometry import rotations
from scipy.spatial.transform import Rotation

from inhand.__main__ import main


def all_messages(dataset: Dataset, kind: type) -> dict[str, list[Any]]:
    """The messages of a kind by the name of their recording."""
    return {
        Path(entry.file).stem: [
            message
            for recorded in read_recording(dataset.path(entry))
            if isinstance(message := recorded.message(), kind)
        ]
        for entry in dataset.entries
    }


def turn(axis: str, degrees: float, shift: tuple[float, ...] = (0.0, 0.0, 0.0)) -> list[float]:
    matrix = np.eye(4)
    matrix[:3, :3] = Rotation.from_euler(axis, degrees, degrees=True).as_matrix().round(4)
    matrix[:3, 3] = shift
    return matrix.ravel().tolist()


def test_corners_of_the_mesh_lie_at_the_pixels_that_were_computed_by_hand(tmp_path: Path) -> None:
    dataset = import_bop([save_bop(tmp_path / "in")], tmp_path / "out")
    entry = only_entry(dataset)
    assert (entry.file, entry.object) == ("recordings/test_000001.mcap", "obj_000001")
    vertices = dataset.shape("obj_000001").vertices
    camera = load_camera(dataset.path(entry))
    (label,) = all_messages(dataset, ObjectPose)["test_000001"]
    pose = label.camera_from_object
    assert camera is not None
    for corner, pixel in CORNERS.items():
        (vertex,) = vertices[np.linalg.norm(vertices - np.array(corner) / 1000.0, axis=1) < 1e-6]
        place = rotations.rotate(np.array(pose.rotation), vertex) + pose.translation
        np.testing.assert_allclose(camera.project(place[None])[0], pixel, atol=1e-3)


@pytest.mark.parametrize("depth_scale", [0.1, 1.0])
def test_pixels_show_the_cube_where_it_is_and_as_far_away(
    tmp_path: Path, depth_scale: float
) -> None:
    save_scene(tmp_path / "in/test/000001", {0: [instance()]}, depth_scale=depth_scale)
    info, frame, _ = messages_of(import_bop([tmp_path / "in"], tmp_path / "out"))
    assert (info.width, info.height, info.has_colour, info.has_depth) == (64, 48, True, True)
    depth = decode_depth(frame.depth) * info.depth_scale
    assert depth[20, 40] == pytest.approx(0.95)
    assert depth[20, 20] == 0.0
    np.testing.assert_allclose(decode_colour(frame.colour)[20, 44], (220, 0, 0), atol=12)


@pytest.mark.parametrize("colour", ["gray/{:06}.png", "rgb/{:06}.jpg", "gray/{:06}.tif"])
def test_grey_and_jpeg_images_without_depth_are_read(tmp_path: Path, colour: str) -> None:
    save_scene(tmp_path / "test/000001", {0: [instance()]}, colour=colour, with_depth=False)
    info, frame, _ = messages_of(import_bop([tmp_path], tmp_path / "out"))
    assert (info.has_colour, info.has_depth, frame.depth) == (True, False, None)
    red, green, _ = decode_colour(frame.colour)[20, 44].astype(int)
    assert red == pytest.approx(220, abs=12)
    assert (green > 200) == colour.startswith("gray")


def test_numbers_of_images_say_when_they_were_and_gaps_stay(tmp_path: Path) -> None:
    save_scene(tmp_path / "in/test/000048", {n: [instance()] for n in (1, 36, 47)})
    frames = all_messages(import_bop([tmp_path / "in"], tmp_path / "out"), RgbdFrame)
    taken = [(f.sequence, f.time_ns - START_NS) for f in frames["test_000048"]]
    assert taken == [(0, 0), (35, 1_166_666_666), (46, 1_533_333_333)]


def test_scenes_objects_and_instances_are_kept_apart(tmp_path: Path) -> None:
    root = tmp_path / "in"
    save_models(root / "models", (1, 5))
    save_models(root / "models_eval", (1, 5))
    save_scene(root / "train_pbr" / "000000", {0: [instance(5)]})
    save_scene(root / "test" / "000000", {0: [instance(1), instance(5), instance(1)], 1: []})
    dataset = import_bop([root], tmp_path / "out")
    objects = {e.file: e.object for e in load_dataset(tmp_path / "out").entries}
    assert objects == {
        "recordings/test_000000.mcap": None,
        "recordings/train_pbr_000000.mcap": "obj_000005",
    }
    labels = all_messages(dataset, ObjectPose)["test_000000"]
    assert [label.object for label in labels] == ["obj_000001", "obj_000005", "obj_000001_2"]
    assert len(dataset.shape("obj_000001_2").vertices) == 8
    assert len(all_messages(dataset, RgbdFrame)["test_000000"]) == 2


def test_each_camera_of_a_scene_has_a_recording(tmp_path: Path) -> None:
    scene = save_scene(tmp_path / "in/test/000001", {n: [instance()] for n in range(3)})
    cropped = [200.0, 0.0, 30.0, 0.0, 200.0, 24.0, 0.0, 0.0, 1.0]
    cameras = {n: {"cam_K": cropped, "depth_scale": 0.1} for n in range(3)}
    cameras[1]["cam_K"] = [201.0, *cropped[1:]]
    save_json(scene / "scene_camera.json", cameras)
    dataset = import_bop([tmp_path / "in"], tmp_path / "out")
    infos = all_messages(dataset, CameraInfo)
    assert [(name, one.fx, one.cx) for name, (one,) in infos.items()] == [
        ("test_000001", 200.0, 30.0),
        ("test_000001_camera2", 201.0, 30.0),
    ]
    frames = all_messages(dataset, RgbdFrame)
    assert [[f.sequence for f in some] for some in frames.values()] == [[0, 2], [1]]


def test_each_sensor_of_a_scene_has_a_recording(tmp_path: Path) -> None:
    for sensor, image in (("_photoneo", "gray_photoneo"), ("_realsense", "rgb_realsense")):
        save_scene(
            tmp_path / "in/test/000001",
            {0: [instance()]},
            sensor=sensor,
            colour=image + "/{:06}.png",
        )
    frames = all_messages(import_bop([tmp_path / "in"], tmp_path / "out"), RgbdFrame)
    assert list(frames) == ["test_000001_photoneo", "test_000001_realsense"]
    assert all(f.colour and f.depth for some in frames.values() for f in some)


def test_the_visible_share_of_an_instance_is_optional(tmp_path: Path) -> None:
    scene = save_scene(tmp_path / "in/test/000001", {0: [instance(), instance(2)]})
    labels = all_messages(import_bop([scene], tmp_path / "out"), ObjectPose)["test_000001"]
    assert [label.visible_fraction for label in labels] == [None, None]
    save_json(scene / "scene_gt_info.json", {0: [{"visib_fract": 0.25}, {"visib_fract": 1.0}]})
    labels = all_messages(import_bop([scene], tmp_path / "other"), ObjectPose)["test_000001"]
    assert [label.visible_fraction for label in labels] == [0.25, 1.0]


@pytest.mark.parametrize(
    ("info", "orders"),
    [
        ({}, []),
        ({"symmetries_continuous": [{"axis": [0, 0, 1], "offset": [0, 0, 0]}]}, [0]),
        ({"symmetries_discrete": [turn("z", 180.0)]}, [2]),
        ({"symmetries_discrete": [turn("z", 120.0), turn("z", 240.0)]}, [3]),
        ({"symmetries_discrete": [turn("z", 90.0), turn("z", 180.0), turn("x", 180.0)]}, [4, 2]),
        ({"symmetries_discrete": [turn(axis, 180.0) for axis in "xyz"]}, [2, 2]),
    ],
)
def test_symmetries_are_carried_over(
    tmp_path: Path, info: dict[str, Any], orders: list[int]
) -> None:
    save_models(tmp_path / "in/models", **info)
    save_scene(tmp_path / "in/test/000001", {0: [instance()]})
    symmetries = import_bop([tmp_path / "in"], tmp_path / "out").shape("obj_000001").symmetries
    assert [symmetry.order for symmetry in symmetries] == orders
    for matrix in info.get("symmetries_discrete", ()):
        equal = rotations.from_matrix(np.array(matrix).reshape(4, 4)[:3, :3])
        assert least_angle(equal[None], symmetries)[0] < 0.01


def test_every_turn_of_a_cube_is_known_from_few_axes(tmp_path: Path) -> None:
    turns = []
    for one in Rotation.create_group("O"):
        matrix = np.eye(4)
        matrix[:3, :3] = one.as_matrix()
        turns.append(matrix.ravel().tolist())
    save_models(tmp_path / "in/models", symmetries_discrete=turns)
    save_scene(tmp_path / "in/test/000001", {0: [instance()]})
    symmetries = import_bop([tmp_path / "in"], tmp_path / "out").shape("obj_000001").symmetries
    assert math.prod(symmetry.order for symmetry in symmetries) <= 64
    equal = Rotation.create_group("O").as_quat(scalar_first=True)
    assert least_angle(equal, symmetries).max() < 1e-6


def test_centres_of_symmetries_are_metres(tmp_path: Path) -> None:
    # A half turn about the vertical through (10, 20, z) takes the origin to (20, 40, 0).
    save_models(
        tmp_path / "in/models",
        symmetries_discrete=[turn("z", 180.0, (20.0, 40.0, 0.0))],
        symmetries_continuous=[{"axis": [0, 0, 1], "offset": [3.0, 4.0, 0.0]}],
    )
    save_scene(tmp_path / "in/test/000001", {0: [instance()]})
    symmetries = import_bop([tmp_path / "in"], tmp_path / "out").shape("obj_000001").symmetries
    np.testing.assert_allclose(symmetries[0].centre, (0.003, 0.004, 0.0), atol=1e-9)
    np.testing.assert_allclose(symmetries[1].centre, (0.01, 0.02, 0.0), atol=1e-9)


def test_frames_without_an_image_and_scenes_without_truth_are_left_out_with_a_warning(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    scene = save_scene(tmp_path / "in/test/000001", {n: [instance()] for n in range(4)})
    private = save_scene(tmp_path / "in/test/000002", {0: [instance()]})
    (private / "scene_gt.json").unlink()
    (scene / "rgb/000001.png").unlink()
    (scene / "depth/000001.png").unlink()
    (scene / "depth/000003.png").unlink()
    frames = all_messages(import_bop([tmp_path / "in"], tmp_path / "out"), RgbdFrame)
    assert [f.sequence for f in frames["test_000001"]] == [0, 2, 3]
    for words in ("has no scene_gt.json", "1 of 4 frames have no image", "1 of 3 frames have no d"):
        assert words in caplog.text


@pytest.mark.parametrize(
    ("changes", "complaint"),
    [
        ({"cam_R_m2c": [0.0] * 9}, "no rotation"),
        ({"cam_R_m2c": [1.0, 0, 0, 0, 1, 0, 0, 0, -1]}, "no rotation"),
        ({"cam_R_m2c": [1.0]}, "not 9 and 3 numbers"),
        ({"cam_t_m2c": [0.05, -0.02, 1.0]}, "in millimetres in BOP"),
        ({"cam_t_m2c": "far"}, "not as BOP has it"),
    ],
)
def test_a_wrong_pose_is_refused_in_one_line(
    tmp_path: Path, changes: dict[str, Any], complaint: str
) -> None:
    save_scene(tmp_path / "in/test/000001", {0: [instance(**changes)]})
    with pytest.raises(DatasetError, match=complaint) as caught:
        import_bop([tmp_path / "in"], tmp_path / "out")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("camera", "complaint"),
    [
        ({"cam_K": [1.0]}, "9 finite numbers"),
        ({"cam_K": [200.0, 9.0, 32.0, 0.0, 200.0, 24.0, 0.0, 0.0, 1.0]}, "skew"),
        ({"cam_K": [2.0, 0.0, 32.0, 0.0, 2.0, 24.0, 0.0, 0.0, 1.0]}, "focal length"),
        ({"depth_scale": 0.0}, "above 0"),
        ({"cam_K": None}, "not as BOP has it"),
    ],
)
def test_a_wrong_camera_is_refused(tmp_path: Path, camera: dict[str, Any], complaint: str) -> None:
    save_scene(tmp_path / "in/test/000001", {0: [instance()]}, camera=camera)
    with pytest.raises(DatasetError, match=complaint):
        import_bop([tmp_path / "in"], tmp_path / "out")


@pytest.mark.parametrize(
    ("spoil", "complaint"),
    [
        (lambda root: save_json(root / "test/000001/scene_camera.json", {}), "has no image 0"),
        (lambda root: save_json(root / "test/000001/scene_gt_info.json", {0: []}), "0 instances"),
        (lambda root: (root / "test/000001/scene_gt.json").write_text("{"), "not as BOP has it"),
        (lambda root: (root / "test/000001/rgb/000000.png").write_bytes(b""), "no image that can"),
        (
            lambda root: save_json(
                root / "models/models_info.json", {1: {"symmetries_discrete": [[1.0]]}}
            ),
            "4 × 4",
        ),
        (
            lambda root: save_json(
                root / "models/models_info.json", {1: {"symmetries_discrete": [turn("z", 7.3)]}}
            ),
            "turns by 7.3",
        ),
        (lambda root: save_json(root / "models/models_info.json", {1: {"diameter": 0.17}}), "mill"),
    ],
)
def test_a_damaged_data_set_is_refused(
    tmp_path: Path, spoil: Callable[[Path], object], complaint: str
) -> None:
    root = save_bop(tmp_path / "in")
    spoil(root)
    with pytest.raises(DatasetError, match=complaint):
        import_bop([root], tmp_path / "out")


def test_a_damaged_scene_among_good_ones_is_named_and_left_out(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    root = save_bop(tmp_path / "in")
    save_scene(root / "test/000002", {0: [instance()]})
    (root / "test/000002/scene_gt.json").write_text("{")
    assert len(import_bop([root], tmp_path / "out").entries) == 1
    assert "000002" in caplog.text
    assert "the scene is left out" in caplog.text


def test_two_data_sets_are_not_mixed(tmp_path: Path) -> None:
    roots = [save_bop(tmp_path / name) for name in ("one", "other")]
    with pytest.raises(DatasetError, match="2 data sets"):
        import_bop(roots, tmp_path / "out")


def test_the_command_says_that_nobody_is_there_and_training_ends_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    root = save_bop(tmp_path / "in")
    save_scene(root / "test/000002", {0: [instance()]})
    assert main(["import", "bop", str(root), str(tmp_path / "out")]) == 0
    assert "nobody is in these recordings" in " ".join(capsys.readouterr().out.split())
    assert main(["train", str(tmp_path / "out"), "-o", str(tmp_path / "m")]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert "holds no skeletons" in line


def test_grey_of_twelve_bits_is_as_bright_as_of_eight(tmp_path: Path) -> None:
    scene = save_scene(tmp_path / "test/000001", {0: [instance()]}, colour="gray/{:06}.png")
    pixels = np.full((48, 64), 1600, np.uint16)
    pixels[0] = 4080
    cv2.imwrite(str(scene / "gray/000000.png"), pixels)
    _, frame, _ = messages_of(import_bop([tmp_path], tmp_path / "out"))
    assert np.median(decode_colour(frame.colour)) == pytest.approx(100, abs=1)
