"""UTD-MHAD's skeletons and depth as datasets."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io
from foreign_data import messages_of, only_entry, save_trial
from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.datasets.labelled_sequence import labelled_sequence
from inhand_lab.datasets.recorded_frames import iterate_pixels, load_camera, load_frames
from inhand_lab.importers.utd_mhad import import_utd_mhad
from inhand_runtime.pixels import decode_depth
from inhand_schemas.joints import Joint
from inhand_schemas.messages import CameraInfo, Skeletons
from inhand_tracker.body.skeleton import pelvis_basis
from inhand_tracker.geometry.rotations import to_matrix
from real_data import DATA, needs_real_data


def first_joints(dataset: Dataset) -> np.ndarray:
    """The joints (20, 3) of the first frame, as they were measured."""
    skeletons = next(one for one in messages_of(dataset) if isinstance(one, Skeletons))
    return np.array(skeletons.people[0].joints)


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
        joints = first_joints(dataset)
        # A proper rotation of Kinect's frame keeps left and right apart.
        axes = to_matrix(pelvis_basis(joints).rotations)
        np.testing.assert_allclose(axes, np.diag([1.0, -1.0, -1.0]), atol=1e-9)
        assert joints[Joint.HAND_LEFT, 0] > joints[Joint.HAND_RIGHT, 0]
        assert joints[Joint.HEAD, 1] < joints[Joint.FOOT_LEFT, 1]

    def test_joints_project_onto_their_own_depth(self, tmp_path: Path) -> None:
        dataset = import_utd_mhad([save_trial(tmp_path, 1, 1)], tmp_path / "out")
        path = dataset.path(only_entry(dataset))
        joints = first_joints(dataset)
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
    def test_wrong_depth_is_named_and_its_skeletons_come_without_it(
        self, tmp_path: Path, depth: np.ndarray, caplog: pytest.LogCaptureFixture
    ) -> None:
        source = save_trial(tmp_path, 2, 2)
        scipy.io.savemat(tmp_path / "a15_s3_t2_depth.mat", {"d_depth": depth})
        info, *messages = messages_of(import_utd_mhad([source], tmp_path / "out"))
        assert "a15_s3_t2_depth.mat: d_depth is" in caplog.text
        assert not info.has_depth
        assert len(messages) == 2

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


@needs_real_data
class TestRealData:
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


class TestNobody:
    def save(self, folder: Path, shown: slice, stem: str) -> Path:
        """A trial whose skeletons are all zero but in some frames."""
        path = save_trial(folder, 12, None, stem)
        joints = scipy.io.loadmat(path)["d_skel"]
        zeros = np.zeros_like(joints)
        zeros[..., shown] = joints[..., shown]
        scipy.io.savemat(path, {"d_skel": zeros})
        return path

    def test_frames_whose_skeleton_is_all_zero_show_nobody(self, tmp_path: Path) -> None:
        source = self.save(tmp_path, slice(3, 12), "a15_s3_t2")
        dataset = import_utd_mhad([source], tmp_path / "out")
        frames = load_frames(dataset.path(only_entry(dataset)), None)
        assert [len(frame.people) for frame in frames] == [0] * 3 + [1] * 9

    def test_a_trial_that_shows_nobody_is_named_and_left_out(
        self, tmp_path: Path, caplog: pytest.LogCaptureFixture
    ) -> None:
        self.save(tmp_path, slice(0, 0), "a15_s3_t2")
        save_trial(tmp_path, 12, None, "a15_s3_t3")
        dataset = import_utd_mhad([tmp_path], tmp_path / "out")
        assert only_entry(dataset).file == "recordings/a15_s3_t3.mcap"
        assert "a15_s3_t2_skeleton.mat has no frame with a body" in caplog.text
        with pytest.raises(DatasetError, match=r"a15_s3_t2_skeleton\.mat has no frame with a body"):
            import_utd_mhad([tmp_path / "a15_s3_t2_skeleton.mat"], tmp_path / "other")
