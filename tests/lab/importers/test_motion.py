"""Motion archives as datasets."""

import logging
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from foreign_data import (
    CUBE,
    archive_values,
    messages_of,
    only_entry,
    save_archive,
)
from inhand_lab.datasets.dataset import START_NS, DatasetEntry, DatasetError, load_dataset
from inhand_lab.datasets.labelled_sequence import labelled_sequence
from inhand_lab.datasets.recorded_frames import load_camera, load_frames
from inhand_lab.importers.motion import import_motion
from inhand_schemas.joints import JOINT_NAMES, Joint
from inhand_schemas.messages import CameraInfo
from inhand_tracker.body.skeleton import PELVIS_JOINTS, pelvis_basis
from inhand_tracker.geometry.rotations import to_matrix
from real_data import DATA, needs_real_data
from scipy.spatial.transform import Rotation


class TestMotion:
    def test_the_entry_tells_what_the_archive_does(self, tmp_path: Path) -> None:
        import_motion([save_archive(tmp_path / "walk.npz")], tmp_path / "out")
        assert only_entry(load_dataset(tmp_path / "out")) == DatasetEntry(
            file="recordings/walk.mcap",
            interaction="carryCube",
            participant="somebody",
            object="large_cube",
            handedness="left",
            frame_rate=30.0,
        )

    def test_the_person_stands_3_m_before_the_camera_upright_and_faces_it(
        self, tmp_path: Path
    ) -> None:
        dataset = import_motion([save_archive(tmp_path / "walk.npz")], tmp_path / "out")
        joints = labelled_sequence(dataset, only_entry(dataset)).joints
        np.testing.assert_allclose(joints[0, Joint.HIP_CENTER], [0.0, 0.0, 3.0], atol=1e-9)
        axes = to_matrix(pelvis_basis(joints[0]).rotations)
        np.testing.assert_allclose(axes, np.diag([1.0, -1.0, -1.0]), atol=1e-9)
        # 5 kept frames later the person has come 8 × 5 cm nearer: one transform for all frames.
        np.testing.assert_allclose(joints[5, Joint.HIP_CENTER], [0.0, 0.0, 2.6], atol=1e-9)

    def test_body_and_object_keep_their_places_to_each_other(self, tmp_path: Path) -> None:
        values = archive_values()
        dataset = import_motion([save_archive(tmp_path / "walk.npz")], tmp_path / "out")
        sequence = labelled_sequence(dataset, only_entry(dataset))

        def distances(joints: np.ndarray, places: np.ndarray, turns: np.ndarray) -> np.ndarray:
            turn = Rotation.from_quat(turns, scalar_first=True)
            corners = np.stack([turn.apply(corner) for corner in CUBE], axis=1) + places[:, None]
            return np.linalg.norm(joints[:, :, None] - corners[:, None], axis=-1)

        poses = values["object_pose"][::8]
        np.testing.assert_allclose(
            distances(sequence.joints, sequence.translations, sequence.rotations),
            distances(values["joints"][::8], poses[:, :3], poses[:, 3:]),
            rtol=0.0,
            atol=1e-12,
        )

    def test_every_eighth_frame_of_240_makes_30_with_exact_times(self, tmp_path: Path) -> None:
        dataset = import_motion([save_archive(tmp_path / "walk.npz")], tmp_path / "out")
        frames = load_frames(dataset.path(only_entry(dataset)), "large_cube")
        assert [frame.sequence for frame in frames] == list(range(6))
        assert [frame.time_ns - START_NS for frame in frames] == [
            0,
            33_333_333,
            66_666_666,
            100_000_000,
            133_333_333,
            166_666_666,
        ]

    def test_another_frame_rate_is_taken_when_it_divides(self, tmp_path: Path) -> None:
        source = save_archive(tmp_path / "walk.npz")
        dataset = import_motion([source], tmp_path / "out", frame_rate=80.0)
        assert len(load_frames(dataset.path(only_entry(dataset)), "large_cube")) == 16
        assert only_entry(dataset).frame_rate == 80.0

    @pytest.mark.parametrize("frame_rate", [7.0, 100.0, 480.0])
    def test_a_frame_rate_that_does_not_divide_is_refused(
        self, tmp_path: Path, frame_rate: float
    ) -> None:
        source = save_archive(tmp_path / "walk.npz")
        with pytest.raises(DatasetError, match=r"walk\.npz was recorded at 240 Hz"):
            import_motion([source], tmp_path / "out", frame_rate=frame_rate)

    def test_joints_are_found_by_their_names(self, tmp_path: Path) -> None:
        values = archive_values()
        shuffled = np.random.default_rng(0).permutation(20)
        source = save_archive(
            tmp_path / "shuffled.npz",
            joints=values["joints"][:, shuffled],
            joint_names=values["joint_names"][shuffled],
        )
        plain = import_motion([save_archive(tmp_path / "plain.npz")], tmp_path / "a")
        other = import_motion([source], tmp_path / "b")
        np.testing.assert_array_equal(
            labelled_sequence(plain, only_entry(plain)).joints,
            labelled_sequence(other, only_entry(other)).joints,
        )

    def test_what_was_not_measured_is_missing_and_the_first_body_seen_is_placed(
        self, tmp_path: Path
    ) -> None:
        values = archive_values()
        values["joints"][:8] = np.nan
        values["joints"][16:, Joint.WRIST_LEFT, 1] = np.nan
        values["object_pose"][8, 5] = np.nan
        dataset = import_motion([save_archive(tmp_path / "gaps.npz", **values)], tmp_path / "out")
        frames = load_frames(dataset.path(only_entry(dataset)), "large_cube")
        assert frames[0].people == ()
        assert frames[1].people[0].joints[Joint.HIP_CENTER] == pytest.approx((0, 0, 3))
        states = frames[2].people[0].states
        missing = [n for n, state in zip(JOINT_NAMES, states, strict=True) if state == "missing"]
        assert missing == ["WristLeft"]
        assert frames[2].people[0].confidences[Joint.WRIST_LEFT] == 0.0
        assert [frame.label is None for frame in frames[:3]] == [False, True, False]

    def test_zeros_are_not_a_place_and_one_wild_rotation_is_named_and_left_out(
        self, tmp_path: Path, caplog: pytest.LogCaptureFixture
    ) -> None:
        values = archive_values()
        values["joints"][8] = 0.0
        values["joints"][16, [Joint.WRIST_LEFT, Joint.HAND_LEFT]] = 0.0
        values["object_pose"][24] = 0.0
        values["object_pose"][32, 3:] *= 1.2
        dataset = import_motion([save_archive(tmp_path / "gaps.npz", **values)], tmp_path / "out")
        frames = load_frames(dataset.path(only_entry(dataset)), "large_cube")
        assert [len(frame.people) for frame in frames] == [1, 0, 1, 1, 1, 1]
        states = frames[2].people[0].states
        missing = [n for n, state in zip(JOINT_NAMES, states, strict=True) if state == "missing"]
        assert missing == ["WristLeft", "HandLeft"]
        assert [frame.label is None for frame in frames] == [False, False, False, True, True, False]
        assert "no unit quaternions are left out: frame 32" in caplog.text

    def test_an_archive_of_a_body_alone_becomes_a_recording_without_labels(
        self, tmp_path: Path
    ) -> None:
        alone = dict.fromkeys(("object_pose", "vertices", "object"))
        dataset = import_motion([save_archive(tmp_path / "walk.npz", **alone)], tmp_path / "out")
        entry = only_entry(load_dataset(tmp_path / "out"))
        assert (entry.interaction, entry.object) == ("carryCube", None)
        assert not (tmp_path / "out" / "objects").exists()
        assert all(frame.label is None for frame in load_frames(dataset.path(entry), None))
        joints = labelled_sequence(dataset, entry).joints
        np.testing.assert_allclose(joints[0, Joint.HIP_CENTER], [0.0, 0.0, 3.0], atol=1e-9)

    @pytest.mark.parametrize("left_out", [True, False])
    def test_an_upper_body_stands_where_its_shoulders_and_neck_put_it(
        self, tmp_path: Path, left_out: bool
    ) -> None:
        values = archive_values()
        lower = {
            *PELVIS_JOINTS,
            *(j for j in Joint if j.name.startswith(("KNEE", "ANKLE", "FOOT"))),
        }
        upper = [joint for joint in range(20) if joint not in lower]
        if left_out:
            values["joints"] = values["joints"][:, upper]
            values["joint_names"] = values["joint_names"][upper]
        else:
            values["joints"][:, sorted(lower)] = 0.0
        dataset = import_motion([save_archive(tmp_path / "walk.npz", **values)], tmp_path / "out")
        joints = labelled_sequence(dataset, only_entry(dataset)).joints
        assert np.flatnonzero(np.isfinite(joints).all(axis=(0, 2))).tolist() == upper
        aside = joints[0, Joint.SHOULDER_LEFT] - joints[0, Joint.SHOULDER_RIGHT]
        np.testing.assert_allclose(aside, [0.4, 0.0, 0.0], atol=1e-6)
        assert joints[0, Joint.HEAD, 1] < joints[0, Joint.SHOULDER_CENTER, 1]
        assert 2.3 < joints[0, Joint.SHOULDER_CENTER, 2] < 3.5

    def test_a_body_that_cannot_be_placed_is_refused_by_the_joints_that_it_lacks(
        self, tmp_path: Path
    ) -> None:
        joints = archive_values()["joints"]
        joints[:, [*PELVIS_JOINTS, Joint.HEAD]] = np.nan
        source = save_archive(tmp_path / "walk.npz", joints=joints)
        with pytest.raises(DatasetError, match=r"HipCenter, Spine, Head, HipLeft, HipRight never"):
            import_motion([source], tmp_path / "out")

    def test_the_camera_says_that_it_has_no_pixels(self, tmp_path: Path) -> None:
        dataset = import_motion([save_archive(tmp_path / "walk.npz")], tmp_path / "out")
        info = messages_of(dataset)[0]
        assert isinstance(info, CameraInfo)
        assert not info.has_colour
        assert not info.has_depth

    def test_without_a_mesh_the_shape_is_the_hull_of_the_marked_points(
        self, tmp_path: Path
    ) -> None:
        dataset = import_motion([save_archive(tmp_path / "walk.npz")], tmp_path / "out")
        shape = dataset.shape("large_cube")
        np.testing.assert_array_equal(shape.marked_vertices, CUBE)
        assert trimesh.Trimesh(shape.vertices, shape.faces).volume == pytest.approx(0.008)

    @pytest.mark.parametrize("flat", [1, 2], ids=["a plane", "a line"])
    def test_flat_points_make_a_thin_closed_body(self, tmp_path: Path, flat: int) -> None:
        points = CUBE.copy()
        points[:, :flat] = 0.0
        source = save_archive(tmp_path / "flat.npz", vertices=points)
        shape = import_motion([source], tmp_path / "out").shape("large_cube")
        body = trimesh.Trimesh(shape.vertices, shape.faces)
        assert body.is_watertight
        assert sorted(body.extents)[0] == pytest.approx(0.01)
        assert body.volume > 0.0
        np.testing.assert_array_equal(shape.marked_vertices, points)

    def test_a_mesh_of_the_objects_name_beside_the_archive_is_its_shape(
        self, tmp_path: Path
    ) -> None:
        trimesh.creation.icosphere(1, 0.3).export(tmp_path / "largecube.obj")
        dataset = import_motion([save_archive(tmp_path / "walk.npz")], tmp_path / "out")
        shape = dataset.shape("large_cube")
        assert shape.faces.shape == (80, 3)
        np.testing.assert_array_equal(shape.marked_vertices, CUBE)

    def test_a_body_that_cannot_be_is_warned_of(
        self, tmp_path: Path, caplog: pytest.LogCaptureFixture
    ) -> None:
        joints = archive_values()["joints"]
        exchanged = joints.copy()
        names = [Joint.SPINE, Joint.ANKLE_LEFT]
        exchanged[:, names] = joints[:, names[::-1]]
        with caplog.at_level(logging.WARNING):
            import_motion([save_archive(tmp_path / "walk.npz")], tmp_path / "a")
            assert not caplog.messages
            import_motion([save_archive(tmp_path / "odd.npz", joints=exchanged)], tmp_path / "b")
        assert "Spine is 0.93 m from its parent joint" in caplog.text

    @pytest.mark.parametrize(
        ("changes", "complaint"),
        [
            ({"joints": None}, "has no 'joints'"),
            ({"joints": np.zeros((48, 19, 3))}, r"'joints' is float64 of shape \(48, 19, 3\)"),
            ({"joints": np.full((48, 20, 3), np.nan)}, "no frame with a body"),
            ({"joints": np.zeros((48, 20, 3))}, "no frame with a body"),
            ({"joints": np.zeros((0, 20, 3))}, "no frame with a body"),
            ({"joint_names": np.array(["Nose"] * 20)}, "not the 20 joints"),
            ({"object_pose": np.zeros((47, 7))}, "'object_pose' is"),
            ({"object_pose": np.full((48, 7), np.nan)}, "no frame with an object"),
            ({"object_pose": np.zeros((48, 7))}, "no frame with an object"),
            ({"object_pose": np.ones((48, 7))}, "no unit quaternions, in frames 0, 1, 2, 3, 4 and"),
            ({"vertices": CUBE[:2]}, "3 or more finite points"),
            ({"fps": np.array(0.0)}, "fps is 0"),
            ({"handedness": np.array("both")}, "left or right"),
            ({"object": np.array("§")}, "is no name"),
            ({"object": np.array(["cube"], object)}, "no motion archive that can be read"),
        ],
    )
    def test_a_bad_archive_is_refused_in_one_line(
        self, tmp_path: Path, changes: dict[str, Any], complaint: str
    ) -> None:
        source = save_archive(tmp_path / "bad.npz", **changes)
        with pytest.raises(DatasetError, match=complaint) as caught:
            import_motion([source], tmp_path / "out")
        assert "\n" not in str(caught.value)
        assert not (tmp_path / "out").exists()

    @pytest.mark.parametrize("contents", [b"", b"no archive", b"PK\x03\x04", pickle.dumps([1])])
    def test_a_foreign_file_is_refused_in_one_line(self, tmp_path: Path, contents: bytes) -> None:
        (tmp_path / "foreign.npz").write_bytes(contents)
        with pytest.raises(DatasetError, match=r"foreign\.npz is no motion archive") as caught:
            import_motion([tmp_path / "foreign.npz"], tmp_path / "out")
        assert "\n" not in str(caught.value)

    def test_archives_that_mark_other_points_of_one_object_are_refused(
        self, tmp_path: Path
    ) -> None:
        near = save_archive(tmp_path / "near.npz", vertices=CUBE + 0.005)
        far = save_archive(tmp_path / "far.npz", vertices=CUBE + 0.02)
        first = save_archive(tmp_path / "first.npz")
        import_motion([first, near], tmp_path / "out")
        with pytest.raises(DatasetError, match="mark other points of 'large_cube'"):
            import_motion([first, far], tmp_path / "other")


@needs_real_data
class TestRealData:
    def test_golf_swings_are_right_handed_swings_in_view(self, tmp_path: Path) -> None:
        sources = sorted((DATA / "motion").glob("golf_*.npz"))
        dataset = import_motion(sources, tmp_path / "out")
        assert len(dataset.entries) == 5
        for entry in dataset.entries:
            assert (entry.object, entry.handedness) == ("golf_club", "right")
            sequence = labelled_sequence(dataset, entry)
            assert np.isfinite(sequence.joints).all()
            assert np.isfinite(sequence.translations).all()
            camera = load_camera(dataset.path(entry))
            assert camera is not None
            pixels = camera.project(sequence.joints)
            assert ((pixels >= 0.0) & (pixels < [camera.width, camera.height])).mean() > 0.99
            # The grip, 1 cm from the object's origin, stays in the hands.
            hands = sequence.joints[:, [Joint.HAND_LEFT, Joint.HAND_RIGHT]].mean(axis=1)
            assert np.linalg.norm(hands - sequence.translations, axis=1).max() < 0.5

    def test_a_box_has_its_mesh_and_its_misnamed_joints_are_warned_of(
        self, tmp_path: Path, caplog: pytest.LogCaptureFixture
    ) -> None:
        dataset = import_motion([DATA / "motion" / "sub3_largebox_003.npz"], tmp_path / "out")
        assert len(dataset.shape("large_box").faces) == 27_581
        assert "misnamed" in caplog.text


def test_of_several_archives_one_that_shows_nobody_is_named_and_left_out(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    save_archive(tmp_path / "a.npz", joints=np.zeros((48, 20, 3)))
    shown = archive_values()["joints"]
    shown[:5] = 0.0
    save_archive(tmp_path / "b.npz", joints=shown)
    dataset = import_motion([tmp_path], tmp_path / "out", 240.0)
    entry = only_entry(dataset)
    assert entry.file == "recordings/b.mcap"
    assert "a.npz has no frame with a body" in caplog.text
    frames = load_frames(dataset.path(entry), entry.object)
    assert [len(frame.people) for frame in frames] == [0] * 5 + [1] * 43
