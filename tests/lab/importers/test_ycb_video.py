"""YCB-Video's frames as datasets."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import msgspec
import numpy as np
import pytest
import trimesh
from foreign_data import K, messages_of, only_entry, pose_matrix, save_meta, save_video
from inhand_lab.datasets.dataset import START_NS, DatasetError
from inhand_lab.datasets.recorded_frames import iterate_pixels, load_camera
from inhand_lab.importers.ycb_video import import_ycb_video
from inhand_runtime.pixels import decode_colour, decode_depth
from inhand_schemas.messages import ObjectPose, RgbdFrame
from real_data import DATA, needs_real_data
from scipy.spatial.transform import Rotation


class TestYcbVideo:
    def test_a_video_is_one_recording_with_a_label_topic_for_each_object(
        self, tmp_path: Path
    ) -> None:
        dataset = import_ycb_video([save_video(tmp_path / "in")], tmp_path / "out")
        assert only_entry(dataset).object is None
        labels = [m for m in messages_of(dataset) if isinstance(m, ObjectPose)]
        assert [label.object for label in labels] == ["025_mug", "061_foam_brick"] * 3
        mug = labels[2].camera_from_object
        assert mug is not None
        assert mug.translation == pytest.approx((0.1, 0.2, 4.0))
        turned = Rotation.from_quat(mug.rotation, scalar_first=True).as_euler("xyz")
        np.testing.assert_allclose(turned, (0.3, 0.2, 0.1), atol=1e-9)

    def test_frames_keep_their_distances_in_time(self, tmp_path: Path) -> None:
        dataset = import_ycb_video([save_video(tmp_path / "in")], tmp_path / "out")
        frames = list(iterate_pixels(dataset.path(only_entry(dataset))))
        assert [frame.sequence for frame in frames] == [0, 1, 3]
        assert [f.time_ns - START_NS for f in frames] == [0, 33_333_333, 100_000_000]

    def test_a_lower_frame_rate_keeps_the_frames_that_fall_on_it(self, tmp_path: Path) -> None:
        root = save_video(tmp_path / "in", (1, 2, 3, 5, 6))
        dataset = import_ycb_video([root], tmp_path / "out", frame_rate=15.0)
        frames = list(iterate_pixels(dataset.path(only_entry(dataset))))
        assert [decode_depth(f.depth)[0, 0] - 10_000 for f in frames if f.depth] == [1, 3, 5]
        assert [frame.sequence for frame in frames] == [0, 1, 2]

    def test_pixels_and_camera_are_the_files(self, tmp_path: Path) -> None:
        dataset = import_ycb_video([save_video(tmp_path / "in")], tmp_path / "out")
        info, frame = messages_of(dataset)[:2]
        assert (info.width, info.height, info.fx, info.fy) == (32, 24, 100.0, 101.0)
        assert (info.cx, info.cy, info.depth_scale) == (15.5, 11.5, 0.0001)
        assert (decode_depth(frame.depth) == 10_003).all()
        red = decode_colour(frame.colour).reshape(-1, 3).mean(axis=0)
        np.testing.assert_allclose(red, (200, 0, 0), atol=5)

    def test_a_frames_own_annotation_goes_before_the_excerpts(self, tmp_path: Path) -> None:
        root = save_video(tmp_path / "in")
        save_meta(root, 3)
        labels = [
            m
            for m in messages_of(import_ycb_video([root], tmp_path / "out"))
            if isinstance(m, ObjectPose) and m.sequence == 0
        ]
        (mug,) = labels
        assert mug.camera_from_object is not None
        assert mug.camera_from_object.translation[2] == pytest.approx(9.0)

    def test_a_model_is_the_shape_with_the_extremes_of_its_box_marked(self, tmp_path: Path) -> None:
        root = save_video(tmp_path / "in")
        (root / "models" / "025_mug").mkdir(parents=True)
        box = trimesh.creation.box((0.1, 0.2, 0.3)).subdivide()
        box.export(root / "models" / "025_mug" / "textured.obj")
        dataset = import_ycb_video([root], tmp_path / "out")
        marked = dataset.shape("025_mug").marked_vertices
        assert len(marked) == 8
        np.testing.assert_allclose(np.abs(marked), np.tile([0.05, 0.1, 0.15], (8, 1)))
        assert not (tmp_path / "out" / "objects" / "061_foam_brick").exists()

    def test_without_a_model_the_visible_surface_makes_a_hull(self, tmp_path: Path) -> None:
        root = save_video(tmp_path / "in")
        save_meta(root, 3)
        shape = import_ycb_video([root], tmp_path / "out").shape("025_mug")
        extent = np.ptp(shape.vertices, axis=0)
        np.testing.assert_allclose(extent, (0.15, 0.23, 0.0345), atol=1e-6)

    @pytest.mark.parametrize(
        ("spoil", "complaint"),
        [
            (lambda root: (root / "poses.json").unlink(), "has no poses"),
            (lambda root: (root / "poses.json").write_text("{"), "cannot be read"),
            (lambda root: (root / "poses.json").write_text('{"000003": 1}'), "cannot be read"),
            (lambda root: (root / "data/0000/000004-depth.png").unlink(), "is missing"),
            (lambda root: (root / "data/0000/x-color.png").write_bytes(b""), "frame's number"),
        ],
    )
    def test_a_damaged_data_set_is_refused_in_one_line(
        self, tmp_path: Path, spoil: Callable[[Path], object], complaint: str
    ) -> None:
        root = save_video(tmp_path / "in")
        spoil(root)
        with pytest.raises(DatasetError, match=complaint) as caught:
            import_ycb_video([root], tmp_path / "out")
        assert "\n" not in str(caught.value)

    @pytest.mark.parametrize("empty", [True, False])
    def test_a_frame_whose_image_is_damaged_is_named_and_left_out(
        self, tmp_path: Path, empty: bool, caplog: pytest.LogCaptureFixture
    ) -> None:
        root = save_video(tmp_path / "in")
        spoiled = root / "data/0000/000003-depth.png"
        if empty:
            spoiled.write_bytes(b"")
        else:
            cv2.imwrite(str(spoiled), np.zeros((9, 9)))
        messages = messages_of(import_ycb_video([root], tmp_path / "out"))
        assert [one.sequence for one in messages if isinstance(one, RgbdFrame)] == [1, 3]
        assert "000003" in caplog.text
        assert "the frame is left out" in caplog.text

    @pytest.mark.parametrize(
        ("changes", "complaint"),
        [
            ({"depth_divisor": 0}, "depth divisor"),
            ({"K": [[1.0]]}, "camera matrix is not 3 × 3"),
            ({"K": [[1.0], [1.0, 2.0]]}, "camera matrix is not 3 × 3"),
            ({"K": np.zeros((3, 3)).tolist()}, "no focal lengths"),
            ({"poses_3x4": {"22": pose_matrix(1.0)}}, "no class 22"),
            ({"poses_3x4": {"14": np.zeros((3, 4)).tolist()}}, "no rotation"),
        ],
    )
    def test_a_wrong_annotation_is_refused(
        self, tmp_path: Path, changes: dict[str, Any], complaint: str
    ) -> None:
        root = save_video(tmp_path / "in", (1,))
        frame = {"K": K, "depth_divisor": 10_000, "poses_3x4": {}} | changes
        (root / "poses.json").write_bytes(msgspec.json.encode({"000001": frame}))
        with pytest.raises(DatasetError, match=complaint):
            import_ycb_video([root], tmp_path / "out")


@needs_real_data
class TestRealData:
    def test_a_mugs_surface_lies_where_the_camera_measures_it(self, tmp_path: Path) -> None:
        dataset = import_ycb_video([DATA / "ycb-video"], tmp_path / "out")
        path = dataset.path(only_entry(dataset))
        surface = np.loadtxt(DATA / "ycb-video" / "mug_025_partial_surface_from_vertmap.xyz")
        camera = load_camera(path)
        assert camera is not None
        labels = [
            m for m in messages_of(dataset) if isinstance(m, ObjectPose) and m.object == "025_mug"
        ]
        errors = []
        for frame, label in zip(iterate_pixels(path), labels, strict=True):
            pose = label.camera_from_object
            assert frame.depth is not None
            assert pose is not None
            turn = Rotation.from_quat(pose.rotation, scalar_first=True)
            points = turn.apply(surface) + pose.translation
            u, v = np.rint(camera.project(points)).astype(int).T
            measured = decode_depth(frame.depth)[v, u] * 0.0001
            errors.append((points[:, 2] - measured)[measured > 0.0])
        assert len(errors) == 10
        assert abs(np.median(np.concatenate(errors))) < 0.001
        for name in ("009_gelatin_box", "025_mug", "061_foam_brick"):
            extents = np.ptp(dataset.shape(name).vertices, axis=0)
            assert ((extents > 0.02) & (extents < 0.12)).all()
