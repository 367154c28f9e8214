"""What holds for recordings of skeletons in any other convention."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from foreign_data import messages_of, only_entry
from foreign_skeletons import (
    START_MS,
    azure_kinect_values,
    coco_values,
    ntu_text,
    save_json,
    save_npz,
    save_text,
    standing_before_camera,
    zed_values,
)
from inhand_lab.datasets.dataset import START_NS, Dataset, DatasetError, load_dataset
from inhand_lab.datasets.recorded_frames import load_frames
from inhand_lab.importers.azure_kinect import AZURE_KINECT, import_azure_kinect
from inhand_lab.importers.coco import COCO, import_coco
from inhand_lab.importers.ntu import NTU, import_ntu
from inhand_lab.importers.zed import ZED, import_zed
from inhand_recorder.verification import examine_recording
from inhand_schemas.joints import Joint
from inhand_schemas.messages import CameraInfo, Skeletons
from inhand_tracker.body.stand_ins import REPLACEABLE

from inhand.__main__ import main

Import = Callable[[list[Path], Path], Dataset]
FORMATS: dict[str, tuple[Import, Callable[[Path, int], Path]]] = {
    "azure-kinect": (
        import_azure_kinect,
        lambda folder, frames: save_json(folder / "walk.json", azure_kinect_values(frames)),
    ),
    "zed": (import_zed, lambda folder, frames: save_json(folder / "walk.json", zed_values(frames))),
    "ntu": (
        import_ntu,
        lambda folder, frames: save_text(
            folder / "S001C001P008R001A023.skeleton", ntu_text(frames)
        ),
    ),
    "coco": (
        import_coco,
        lambda folder, frames: save_npz(folder / "walk.npz", coco_values(frames)),
    ),
}


# Human3.6M's 17 joints by those of COCO that are about there: pelvis, right leg, left leg, trunk
# and head, left arm, right arm.
HUMAN36M = [11, 12, 14, 16, 11, 13, 15, 6, 5, 0, 1, 5, 7, 9, 6, 8, 10]


LEGS = ("hip", "knee", "ankle")
WRISTS = {
    name: table.joints.index(joint)
    for name, table, joint in (
        ("azure-kinect", AZURE_KINECT, "WRIST_LEFT"),
        ("zed", ZED, "LEFT_WRIST"),
        ("ntu", NTU, "WristLeft"),
        ("coco", COCO, "left_wrist"),
    )
}


def write_zeros(name: str, path: Path, frame: int, joint: int | None) -> None:
    """Put a joint, or all of them, at zero in one frame of a file."""
    which = slice(None) if joint is None else slice(joint, joint + 1)
    if name == "coco":
        values = dict(np.load(path))
        values["keypoints"][frame, ..., which, :] = 0.0
        save_npz(path, values)
    elif name == "ntu":
        lines = path.read_text().splitlines()
        rows = [line for line, text in enumerate(lines) if len(text.split()) == 12]
        first = 25 * (frame - 1)  # nobody is in the first frame
        for line in rows[first : first + 25][which]:
            lines[line] = " ".join(["0", "0", "0", *lines[line].split()[3:]])
        path.write_text("\n".join(lines))
    else:
        values = json.loads(path.read_text())
        frames = values["frames"] if name == "azure-kinect" else list(values.values())[1:]
        bodies, key = (
            ("bodies", "joint_positions") if name == "azure-kinect" else ("body_list", "keypoint")
        )
        places = frames[frame][bodies][0][key]
        places[which] = [[0.0, 0.0, 0.0]] * len(places[which])
        path.write_text(json.dumps(values))


def skeletons_of(dataset: Dataset) -> list[Skeletons]:
    return [one for one in messages_of(dataset) if isinstance(one, Skeletons)]


@pytest.mark.parametrize("name", FORMATS)
class TestEveryConvention:
    def test_the_person_stands_where_they_stood_in_metres_upright_facing_the_camera(
        self, name: str, tmp_path: Path
    ) -> None:
        importer, save = FORMATS[name]
        dataset = importer([save(tmp_path, 12)], tmp_path / "out")
        (person,) = skeletons_of(dataset)[-1].people
        ours = np.array(person.joints)
        assert "missing" not in person.states
        assert np.linalg.norm(ours - standing_before_camera(), axis=1).max() < 0.08
        for side in ("LEFT", "RIGHT"):
            if name != "coco":
                hand = Joint[f"HAND_{side}"]
                np.testing.assert_allclose(ours[hand], standing_before_camera()[hand], atol=1e-6)

    def test_every_frame_has_its_time_and_the_person_keeps_an_id(
        self, name: str, tmp_path: Path
    ) -> None:
        importer, save = FORMATS[name]
        skeletons = skeletons_of(importer([save(tmp_path, 12)], tmp_path / "out"))
        assert [one.sequence for one in skeletons] == list(range(12))
        start_ns = 1_000_000 * START_MS if name == "zed" else START_NS
        expected = start_ns + np.arange(12) * 1e9 / 30.0
        times = np.array([one.time_ns for one in skeletons])
        assert np.abs(times - expected).max() <= (1_000_000 if name == "zed" else 1_000)
        assert {person.id for one in skeletons for person in one.people} == {0}

    def test_the_recording_is_whole_and_true_and_read_as_any_other(
        self, name: str, tmp_path: Path
    ) -> None:
        importer, save = FORMATS[name]
        dataset = importer([save(tmp_path, 12)], tmp_path / "out")
        path = dataset.path(only_entry(dataset))
        assert not examine_recording(path).problems
        assert len(load_frames(path, None)) == 12
        info = messages_of(dataset)[0]
        assert isinstance(info, CameraInfo)
        assert (info.has_colour, info.has_depth) == (False, False)
        assert info.frame_rate == pytest.approx(30.0, rel=0.05)

    def test_a_lower_rate_leaves_frames_out(self, name: str, tmp_path: Path) -> None:
        _, save = FORMATS[name]
        source, out = save(tmp_path, 12), tmp_path / "out"
        assert main(["import", name, str(source), str(out), "--frame-rate", "15"]) == 0
        times = [one.time_ns for one in skeletons_of(load_dataset(out))]
        assert len(times) == 6
        assert np.diff(times) / 1e9 == pytest.approx(1.0 / 15.0, abs=0.002)

    def test_a_file_that_is_cut_off_is_refused_in_one_line(self, name: str, tmp_path: Path) -> None:
        importer, save = FORMATS[name]
        source = save(tmp_path, 12)
        whole = source.read_bytes()
        for share in (0.0, 0.3, 0.97):
            source.write_bytes(whole[: int(share * len(whole))])
            with pytest.raises(DatasetError, match=source.name) as caught:
                importer([source], tmp_path / "out")
            assert "\n" not in str(caught.value)
        assert not (tmp_path / "out").exists()

    def test_a_file_that_shows_nobody_is_named_and_left_out(
        self, name: str, tmp_path: Path, caplog: pytest.LogCaptureFixture
    ) -> None:
        importer, save = FORMATS[name]
        source = save(tmp_path, 12)
        empty = tmp_path / f"empty{source.suffix}"
        nobody: Any = {
            "azure-kinect": azure_kinect_values(bodies=0),
            "zed": {"0": {"timestamp": 0}, "1000": {"timestamp": 10**18, "body_list": []}},
            "ntu": "3\n0\n0\n0\n",
            "coco": coco_values() | {"keypoints": np.full((12, 17, 3), np.nan)},
        }[name]
        {"ntu": save_text, "coco": save_npz}.get(name, save_json)(empty, nobody)
        with pytest.raises(DatasetError, match="no frame with a body"):
            importer([empty], tmp_path / "none")
        dataset = importer([source, empty], tmp_path / "out")
        assert only_entry(dataset).file == f"recordings/{source.stem}.mcap"
        assert "empty" in caplog.text

    def test_joints_and_bodies_at_zero_are_missing_and_not_in_the_camera(
        self, name: str, tmp_path: Path
    ) -> None:
        importer, save = FORMATS[name]
        source = save(tmp_path, 12)
        write_zeros(name, source, frame=4, joint=None)
        write_zeros(name, source, frame=6, joint=WRISTS[name])
        skeletons = skeletons_of(importer([source], tmp_path / "out"))
        assert skeletons[4].people == ()
        (person,) = skeletons[6].people
        assert person.states[Joint.WRIST_LEFT] == "missing"
        others = [joint for joint in Joint if not joint.name.startswith(("WRIST", "HAND"))]
        np.testing.assert_allclose(
            np.array(person.joints)[others], np.array(skeletons[5].people[0].joints)[others]
        )

    def test_a_joint_that_is_always_at_zero_is_missing_too(self, name: str, tmp_path: Path) -> None:
        importer, save = FORMATS[name]
        source = save(tmp_path, 12)
        for frame in range(1, 12):
            write_zeros(name, source, frame=frame, joint=WRISTS[name])
        for one in skeletons_of(importer([source], tmp_path / "out"))[1:]:
            assert one.people[0].states[Joint.WRIST_LEFT] == "missing"


class TestPlausibility:
    def keypoints(self, change: Callable[[np.ndarray], np.ndarray], tmp_path: Path) -> Dataset:
        values = coco_values()
        source = save_npz(
            tmp_path / "walk.npz", values | {"keypoints": change(values["keypoints"])}
        )
        return import_coco([source], tmp_path / "out")

    @pytest.mark.parametrize(
        ("change", "complaint"),
        [
            (lambda points: 1000.0 * points, "tall: give --unit millimetres"),
            (lambda points: points / 0.0254, "tall: give --unit inches"),
            (lambda points: 1e5 * points, "no unit makes them a person"),
            (lambda points: points * [1.0, -1.0, -1.0], "behind the camera: axes are not those"),
            (lambda points: points * [-1.0, 1.0, 1.0], "mirror images, 12 of 12 look backwards"),
            (lambda points: points - points[:, 11:13].mean(1, keepdims=True), "relative to"),
            (lambda points: points[:, HUMAN36M], "in another order than COCO's, nose, left_eye"),
        ],
    )
    def test_bodies_that_cannot_be_meant_are_refused_by_what_is_wrong(
        self, change: Callable[[np.ndarray], np.ndarray], complaint: str, tmp_path: Path
    ) -> None:
        with pytest.raises(DatasetError, match=complaint):
            self.keypoints(change, tmp_path)
        assert not (tmp_path / "out").exists()

    def test_a_camera_that_is_upside_down_is_warned_of(
        self, tmp_path: Path, caplog: pytest.LogCaptureFixture
    ) -> None:
        self.keypoints(lambda points: points * [-1.0, -1.0, 1.0], tmp_path)
        assert "people are not upright" in caplog.text

    def test_joints_with_exchanged_sides_are_refused_where_feet_show_it(
        self, tmp_path: Path
    ) -> None:
        text = azure_kinect_values()
        text["joint_names"] = [
            name.replace("LEFT", "left").replace("RIGHT", "LEFT").replace("left", "RIGHT")
            for name in text["joint_names"]
        ]
        with pytest.raises(DatasetError, match="left and right joints have each other's names"):
            import_azure_kinect([save_json(tmp_path / "a.json", text)], tmp_path / "out")


def test_people_at_a_table_without_hips_are_upper_bodies(tmp_path: Path) -> None:
    values = coco_values()
    hidden = [COCO.joints.index(f"{side}_{name}") for side in ("left", "right") for name in LEGS]
    values["keypoints"][:, hidden] = np.nan
    (*_, last) = skeletons_of(import_coco([save_npz(tmp_path / "a.npz", values)], tmp_path / "out"))
    (person,) = last.people
    missing = {joint for joint in Joint if person.states[joint] == "missing"}
    assert missing <= set(REPLACEABLE)
    assert {Joint.HIP_CENTER, Joint.KNEE_LEFT, Joint.FOOT_RIGHT} <= missing


class TestTimes:
    def saved(self, times: Any, tmp_path: Path) -> list[int]:
        values = coco_values(len(times)) | {"times": np.array(times, float)}
        dataset = import_coco([save_npz(tmp_path / "walk.npz", values)], tmp_path / "out")
        return [one.time_ns - START_NS for one in skeletons_of(dataset)]

    def test_a_gap_stays_a_gap(self, tmp_path: Path) -> None:
        times = self.saved([100.0, 100.04, 107.0, 107.04], tmp_path)
        np.testing.assert_allclose(times, [0, 4e7, 7e9, 7.04e9], atol=10)

    def test_a_slow_recording_is_kept_whole(self, tmp_path: Path) -> None:
        slow = np.arange(10) / 5.0
        assert len(self.saved(slow, tmp_path)) == 10

    def test_times_that_shake_by_a_fifth_of_a_frame_lose_none(self, tmp_path: Path) -> None:
        shaken = np.arange(200) / 30.0 + np.random.default_rng(2).uniform(-0.004, 0.004, 200)
        assert len(self.saved(shaken, tmp_path)) == 200

    def test_frames_of_one_time_are_told_and_kept_once(
        self, tmp_path: Path, caplog: pytest.LogCaptureFixture
    ) -> None:
        assert len(self.saved([0.0, 0.04, 0.04, 0.08], tmp_path)) == 3
        assert "1 frame is of the time of the one before" in caplog.text

    @pytest.mark.parametrize(
        ("times", "complaint"),
        [
            ([0.0, 0.04, 0.01, 0.05], r"the clock steps back by 0\.03 s at frame 2: cut"),
            (np.arange(20) * 33.3, r"33\.3 s apart, in the median: times should be times, in sec"),
            (np.arange(20) * 33e-9, "write nanoseconds|same time_ns"),
            ([0.0, 1e300], "out of range"),
            ([0.0, np.nan], "a finite number of seconds for each of 2 frames"),
        ],
    )
    def test_times_that_no_clock_shows_are_refused(
        self, times: Any, complaint: str, tmp_path: Path
    ) -> None:
        with pytest.raises(DatasetError, match=complaint):
            self.saved(times, tmp_path)
