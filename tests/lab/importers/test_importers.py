"""Foreign data as datasets: small inputs made here, and the real files where they are there."""

import logging
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import msgspec
import numpy as np
import pytest
import scipy.io
import trimesh
from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError, load_dataset
from inhand_lab.datasets.dataset_writer import DatasetWriter
from inhand_lab.datasets.labelled_sequence import labelled_sequence
from inhand_lab.datasets.recorded_frames import iterate_pixels, load_camera, load_frames
from inhand_lab.importers.motion import import_motion
from inhand_lab.importers.timing import START_NS
from inhand_lab.importers.utd_mhad import JOINT_ORDER, import_utd_mhad
from inhand_lab.importers.ycb_video import import_ycb_video
from inhand_runtime.errors import InhandError
from inhand_runtime.pixels import decode_colour, decode_depth
from inhand_runtime.recording import read_recording
from inhand_schemas.joints import JOINT_NAMES, Joint
from inhand_schemas.messages import CameraInfo, ObjectPose
from inhand_tracker.body.skeleton import pelvis_basis
from inhand_tracker.geometry.rotations import to_matrix
from real_data import DATA
from scipy.spatial.transform import Rotation

from inhand.__main__ import main

needs_real_data = pytest.mark.skipif(
    not DATA.is_dir(), reason=f"the real data are not on this machine: no {DATA}"
)

# A person who stands and faces +z, with the left at +x and up at +y.
STANDING = {
    "HipCenter": (0.0, 1.0, 0.0),
    "Spine": (0.0, 1.15, 0.0),
    "ShoulderCenter": (0.0, 1.45, 0.0),
    "Head": (0.0, 1.65, 0.05),
    "Shoulder": (0.2, 1.4, 0.0),
    "Elbow": (0.25, 1.15, 0.02),
    "Wrist": (0.27, 0.95, 0.2),
    "Hand": (0.33, 0.9, 0.25),
    "Hip": (0.1, 0.98, 0.0),
    "Knee": (0.1, 0.5, 0.0),
    "Ankle": (0.1, 0.08, 0.0),
    "Foot": (0.12, 0.02, 0.12),
}
CUBE = 0.2 * np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)


def standing() -> np.ndarray:
    """The joints (20, 3), in the order of JOINT_NAMES."""
    return np.array([_standing_joint(name) for name in JOINT_NAMES])


def _standing_joint(name: str) -> tuple[float, float, float]:
    x, y, z = STANDING[name.removesuffix("Left").removesuffix("Right")]
    return (-x if name.endswith("Right") else x, y, z)


def walking(frames: int, turn: Rotation) -> np.ndarray:
    """Joints (T, 20, 3) of the person walking ahead, in a world frame turned by ``turn``."""
    steps = np.arange(frames)[:, None, None] * np.array([0.0, 0.0, 0.01])
    turned = turn.apply((standing() + steps).reshape(-1, 3)).reshape(frames, 20, 3)
    return turned + np.array([5.0, -2.0, 7.0])


def archive_values(frames: int = 48) -> dict[str, Any]:
    """A motion archive: the person carries a cube, in a world frame of no particular direction."""
    turn = Rotation.from_euler("xyz", (0.4, -1.1, 2.0))
    joints = walking(frames, turn)
    spin = Rotation.from_rotvec(np.linspace((0, 0, 0), (0, 1, 0), frames)) * turn
    return {
        "joints": joints,
        "joint_names": np.array(JOINT_NAMES),
        "object_pose": np.hstack(
            (joints[:, Joint.HAND_RIGHT], spin.as_quat(canonical=True, scalar_first=True))
        ),
        "vertices": CUBE,
        "fps": np.array(240.0),
        "interaction": np.array("carryCube"),
        "object": np.array("largeCube"),
        "participant": np.array("somebody"),
        "handedness": np.array("left"),
    }


def save_archive(path: Path, **changes: Any) -> Path:
    values = archive_values() | changes
    np.savez(path, **{name: value for name, value in values.items() if value is not None})
    return path


def only_entry(dataset: Dataset) -> DatasetEntry:
    (entry,) = dataset.entries
    return entry


def messages_of(dataset: Dataset) -> list[Any]:
    return [r.message() for r in read_recording(dataset.path(only_entry(dataset)))]


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
            ({"joints": np.zeros((0, 20, 3))}, "no frame with a body"),
            ({"joint_names": np.array(["Nose"] * 20)}, "not the 20 joints"),
            ({"object_pose": np.zeros((47, 7))}, "'object_pose' is"),
            ({"object_pose": np.full((48, 7), np.nan)}, "no frame with an object"),
            ({"object_pose": np.zeros((48, 7))}, "no unit quaternions"),
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


def skeleton_file(joints_in_kinect: np.ndarray) -> np.ndarray:
    """d_skel (20, 3, T) from joints (T, 20, 3) in the order of JOINT_NAMES."""
    order = [JOINT_NAMES.index(name) for name in JOINT_ORDER]
    return np.moveaxis(joints_in_kinect[:, order], 0, -1)


def save_trial(
    folder: Path, frames: int, depth_frames: int | None, stem: str = "a15_s3_t2"
) -> Path:
    """A person 2.5 m before a Kinect; each joint's depth is in the pixel that README computes."""
    joints = np.repeat(standing()[None], frames, axis=0)
    # Kinect's x is to the sensor's left, which is a facing person's right.
    joints = (joints - [0.0, 1.0, 0.0]) * [-1.0, 1.0, -1.0] + [0.3, 0.0, 2.5]
    path = folder / f"{stem}_skeleton.mat"
    scipy.io.savemat(path, {"d_skel": skeleton_file(joints)})
    if depth_frames is not None:
        depth = np.zeros((240, 320, depth_frames), np.uint16)
        for x, y, z in joints[0]:
            u, v = round(160 + 285.63 * x / z), round(120 - 285.63 * y / z)
            depth[v, u] = round(1000 * z)
        scipy.io.savemat(folder / f"{stem}_depth.mat", {"d_depth": depth})
    return path


class TestUtdMhad:
    def test_a_trial_has_its_actions_name_and_no_object(self, tmp_path: Path) -> None:
        dataset = import_utd_mhad([save_trial(tmp_path, 3, 3)], tmp_path / "out")
        assert only_entry(dataset) == DatasetEntry(
            file="recordings/a15_s3_t2.mcap",
            interaction="tennisSwing",
            participant="s3",
            object=None,
            frame_rate=30.0,
        )

    @pytest.mark.parametrize(
        ("action", "interaction"),
        [
            (8, "drawX"),
            (14, "baseballSwing"),
            (15, "tennisSwing"),
            (16, "armCurl"),
            (17, "tennisServe"),
            (19, "knock"),
        ],
    )
    def test_actions_are_named(self, tmp_path: Path, action: int, interaction: str) -> None:
        source = save_trial(tmp_path, 1, None, f"a{action}_s1_t1")
        assert only_entry(import_utd_mhad([source], tmp_path / "out")).interaction == interaction

    def test_the_person_faces_the_camera_with_the_left_at_the_images_right(
        self, tmp_path: Path
    ) -> None:
        dataset = import_utd_mhad([save_trial(tmp_path, 1, 1)], tmp_path / "out")
        joints = labelled_sequence(dataset, only_entry(dataset)).joints[0]
        # A proper rotation of Kinect's frame keeps left and right apart.
        axes = to_matrix(pelvis_basis(joints).rotations)
        np.testing.assert_allclose(axes, np.diag([1.0, -1.0, -1.0]), atol=1e-9)
        assert joints[Joint.HAND_LEFT, 0] > joints[Joint.HAND_RIGHT, 0]
        assert joints[Joint.HEAD, 1] < joints[Joint.FOOT_LEFT, 1]

    def test_joints_project_onto_their_own_depth(self, tmp_path: Path) -> None:
        dataset = import_utd_mhad([save_trial(tmp_path, 1, 1)], tmp_path / "out")
        path = dataset.path(only_entry(dataset))
        joints = labelled_sequence(dataset, only_entry(dataset)).joints[0]
        camera = load_camera(path)
        assert camera is not None
        (frame,) = iterate_pixels(path)
        assert frame.depth is not None
        depth = decode_depth(frame.depth)
        for joint, (u, v) in zip(joints, np.rint(camera.project(joints)).astype(int), strict=True):
            assert depth[v, u] == round(1000 * joint[2])

    def test_depth_and_skeletons_are_paired_by_index_up_to_the_shorter(
        self, tmp_path: Path
    ) -> None:
        longer = save_trial(tmp_path, 5, 4, "a8_s1_t1")
        shorter = save_trial(tmp_path, 3, 5, "a8_s1_t2")
        dataset = import_utd_mhad([longer, shorter], tmp_path / "out")
        for entry, frames in zip(dataset.entries, (4, 3), strict=True):
            path = dataset.path(entry)
            pixels = [frame.sequence for frame in iterate_pixels(path)]
            assert pixels == [f.sequence for f in load_frames(path, None)] == list(range(frames))
        assert "unpaired_frames = 3" in (tmp_path / "out" / "dataset.toml").read_text()

    def test_a_trial_without_depth_says_so(self, tmp_path: Path) -> None:
        dataset = import_utd_mhad([save_trial(tmp_path, 2, None)], tmp_path / "out")
        info, *rest = messages_of(dataset)
        assert isinstance(info, CameraInfo)
        assert not info.has_depth
        assert len(rest) == 2

    def test_a_folder_gives_all_of_its_trials(self, tmp_path: Path) -> None:
        for stem in ("a8_s1_t1", "a8_s2_t1"):
            save_trial(tmp_path, 2, 2, stem)
        dataset = import_utd_mhad([tmp_path], tmp_path / "out")
        assert [entry.participant for entry in dataset.entries] == ["s1", "s2"]

    @pytest.mark.parametrize(
        ("contents", "complaint"),
        [
            ({"d_skel": np.zeros((19, 3, 5))}, r"d_skel is \(19, 3, 5\)"),
            ({"d_skel": np.zeros((20, 3, 0))}, "d_skel"),
            ({"d_depth": np.zeros((20, 3, 5))}, "no array of numbers 'd_skel'"),
            ({"d_skel": "text"}, "no array of numbers 'd_skel'"),
        ],
    )
    def test_a_wrong_skeleton_is_refused(
        self, tmp_path: Path, contents: dict[str, Any], complaint: str
    ) -> None:
        scipy.io.savemat(tmp_path / "a8_s1_t1_skeleton.mat", contents)
        with pytest.raises(DatasetError, match=complaint):
            import_utd_mhad([tmp_path], tmp_path / "out")

    @pytest.mark.parametrize("depth", [np.zeros((240, 320, 2)), np.zeros((120, 160, 2), np.uint16)])
    def test_wrong_depth_is_refused(self, tmp_path: Path, depth: np.ndarray) -> None:
        source = save_trial(tmp_path, 2, 2)
        scipy.io.savemat(tmp_path / "a15_s3_t2_depth.mat", {"d_depth": depth})
        with pytest.raises(DatasetError, match="d_depth is"):
            import_utd_mhad([source], tmp_path / "out")

    @pytest.mark.parametrize("contents", [b"", b"not MATLAB at all, but long enough", bytes(200)])
    def test_a_foreign_file_is_refused_in_one_line(self, tmp_path: Path, contents: bytes) -> None:
        source = tmp_path / "a8_s1_t1_skeleton.mat"
        source.write_bytes(contents)
        with pytest.raises(DatasetError, match=r"a8_s1_t1_skeleton\.mat") as caught:
            import_utd_mhad([source], tmp_path / "out")
        assert "\n" not in str(caught.value)

    @pytest.mark.parametrize("stem", ["swing", "a28_s1_t1", "a0_s1_t1"])
    def test_a_file_with_a_foreign_name_is_refused(self, tmp_path: Path, stem: str) -> None:
        source = save_trial(tmp_path, 1, None, stem)
        with pytest.raises(DatasetError, match="not named as UTD-MHAD names files"):
            import_utd_mhad([source], tmp_path / "out")


K = [[100.0, 0.0, 15.5], [0.0, 101.0, 11.5], [0.0, 0.0, 1.0]]


def pose_matrix(z: float) -> list[list[float]]:
    turned = Rotation.from_euler("xyz", (0.3, 0.2, 0.1)).as_matrix()
    return np.hstack((turned, [[0.1], [0.2], [z]])).tolist()


def save_video(root: Path, numbers: tuple[int, ...] = (3, 4, 6)) -> Path:
    """An excerpt of frames of 32 × 24 with a mug and a brick, poses in ``poses.json``."""
    folder = root / "data" / "0000"
    folder.mkdir(parents=True)
    colour = np.zeros((24, 32, 3), np.uint8)
    colour[..., 2] = 200
    poses = {}
    for number in numbers:
        cv2.imwrite(str(folder / f"{number:06}-color.png"), colour)
        depth = np.full((24, 32), 10_000 + number, np.uint16)
        cv2.imwrite(str(folder / f"{number:06}-depth.png"), depth)
        poses[f"{number:06}"] = {
            "K": K,
            "depth_divisor": 10_000,
            "poses_3x4": {"14": pose_matrix(number), "21": pose_matrix(2.0)},
        }
    (root / "poses.json").write_bytes(msgspec.json.encode(poses))
    return root


def save_meta(root: Path, number: int) -> None:
    """The data set's own annotation of a frame: a mug whose surface fills half of the image."""
    stem = root / "data" / "0000" / f"{number:06}"
    rows, columns = np.mgrid[0:24, 0:32]
    surface = np.dstack((columns / 100.0, rows / 100.0, columns * rows / 10_000.0))
    labels = np.where(columns < 16, 14, 0).astype(np.uint8)
    cv2.imwrite(f"{stem}-label.png", labels)
    scipy.io.savemat(
        f"{stem}-meta.mat",
        {
            "cls_indexes": np.array([[14]]),
            "poses": np.array(pose_matrix(9.0))[..., None],
            "intrinsic_matrix": np.array(K),
            "factor_depth": np.array([[10_000]]),
            "vertmap": surface.astype(np.float32),
        },
    )


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
            (lambda root: (root / "data/0000/000004-depth.png").write_bytes(b""), "no image"),
            (lambda root: (root / "data/0000/x-color.png").write_bytes(b""), "frame's number"),
            (
                lambda root: cv2.imwrite(
                    str(root / "data/0000/000004-depth.png"), np.zeros((9, 9))
                ),
                "should be uint16",
            ),
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


@pytest.mark.parametrize("name", ["motion", "utd-mhad", "ycb-video"])
class TestEveryImport:
    def test_a_source_that_is_missing_is_told_in_one_line(
        self, name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
    ) -> None:
        assert main(["import", name, str(tmp_path / "missing"), str(tmp_path / "out")]) == 1
        (line,) = capsys.readouterr().err.splitlines()
        assert line.startswith("inhand import: ")
        assert "missing" in line

    def test_an_empty_folder_is_told_in_one_line(
        self, name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
    ) -> None:
        assert main(["import", name, str(tmp_path), str(tmp_path / "out")]) == 1
        assert "holds no" in capsys.readouterr().err

    def test_a_folder_with_a_dataset_is_left_alone(
        self, name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
    ) -> None:
        source = {
            "motion": lambda: save_archive(tmp_path / "walk.npz"),
            "utd-mhad": lambda: save_trial(tmp_path, 1, None),
            "ycb-video": lambda: save_video(tmp_path / "in"),
        }[name]()
        DatasetWriter(tmp_path / "out").finish({})
        before = (tmp_path / "out" / "dataset.toml").read_bytes()
        assert main(["import", name, str(source), str(tmp_path / "out")]) == 1
        assert "holds a dataset already" in capsys.readouterr().err
        assert (tmp_path / "out" / "dataset.toml").read_bytes() == before

    def test_the_verb_makes_a_dataset_that_can_be_loaded(self, name: str, tmp_path: Path) -> None:
        source = {
            "motion": lambda: save_archive(tmp_path / "walk.npz"),
            "utd-mhad": lambda: save_trial(tmp_path, 2, 2),
            "ycb-video": lambda: save_video(tmp_path / "in"),
        }[name]()
        out = tmp_path / "out"
        assert main(["import", name, str(source), str(out), "--frame-rate", "15"]) == 0
        assert only_entry(load_dataset(out)).frame_rate == 15.0


def test_two_sources_of_one_name_are_refused(tmp_path: Path) -> None:
    (tmp_path / "other").mkdir()
    sources = [save_archive(tmp_path / "walk.npz"), save_archive(tmp_path / "other" / "walk.npz")]
    with pytest.raises(InhandError, match="would be the same recording"):
        import_motion(sources, tmp_path / "out")


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

    def test_a_tennis_swings_joints_lie_just_behind_the_persons_surface(
        self, tmp_path: Path
    ) -> None:
        source = DATA / "utd-mhad" / "a15_s1_t1_skeleton.mat"
        dataset = import_utd_mhad([source], tmp_path / "out")
        path = dataset.path(only_entry(dataset))
        joints = labelled_sequence(dataset, only_entry(dataset)).joints
        camera = load_camera(path)
        assert camera is not None
        frames = list(iterate_pixels(path))
        assert len(frames) == len(joints) == 79
        behind = []
        for frame, positions in zip(frames, joints, strict=True):
            assert frame.depth is not None
            depth = decode_depth(frame.depth)
            u, v = np.rint(camera.project(positions)).astype(int).T
            measured = np.where(depth[v, u] > 0, depth[v, u] / 1000.0, np.nan)
            behind.append(positions[:, 2] - measured)
        # Kinect puts joints into the body: 2 to 20 cm behind what it measures of them.
        torso = np.array(behind)[:, : Joint.HEAD + 1]
        assert np.isfinite(torso).mean() > 0.99
        assert (np.nanmedian(torso, axis=0) > 0.02).all()
        assert (np.nanmedian(torso, axis=0) < 0.2).all()

    def test_a_tennis_swing_is_made_with_the_right_arm(self, tmp_path: Path) -> None:
        source = DATA / "utd-mhad" / "a15_s1_t2_skeleton.mat"
        dataset = import_utd_mhad([source], tmp_path / "out")
        joints = labelled_sequence(dataset, only_entry(dataset)).joints
        paths = np.linalg.norm(np.diff(joints, axis=0), axis=-1).sum(axis=0)
        assert paths[Joint.WRIST_RIGHT] > 3.0 * paths[Joint.WRIST_LEFT]

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
