"""Poses, labels and skeletons as tables: the figures are those of the recording."""

import re
from pathlib import Path

import pyarrow.parquet as pq
import pytest
from examples import EXAMPLES
from exported import export
from inhand_recorder.conversion import Selection
from inhand_runtime.recording import RecordingError, RecordingWriter
from inhand_schemas.joints import JOINT_NAMES
from inhand_schemas.topics import POSE
from running_rig import ROOT
from small_rig import DELAY_NS, FRAME_NS, SITE, START_NS, joints_of, pose_of, write_rig

from inhand.exports.parquet import JOINTS, POSES, export_parquet


def test_poses_and_labels_are_exactly_those_of_the_recording(tmp_path: Path) -> None:
    counts = export(export_parquet, write_rig(tmp_path / "one.mcap"), tmp_path / "out")
    assert counts == {"labels": 10, "poses": 10, "skeletons": 200}
    for name, lost in (("labels", ()), ("poses", (4, 9))):
        rows = pq.read_table(tmp_path / "out" / f"{name}.parquet").to_pylist()
        assert [row["time_ns"] for row in rows] == [START_NS + n * FRAME_NS for n in range(10)]
        for number, row in enumerate(rows):
            assert (row["object"], row["camera"], row["rig"]) == ("mug", "front", "rig")
            assert (row["sequence"], row["person"], row["covariance"]) == (number, 7, None)
            shown = [row[one] for one in ("x_m", "y_m", "z_m", "qw", "qx", "qy", "qz")]
            pose = pose_of(number)
            expected = [*pose.translation, *pose.rotation]
            assert shown == (expected if number not in lost else [None] * 7)
    assert rows[0]["received_ns"] == START_NS + 4 * DELAY_NS


def test_each_joint_is_a_row_and_a_missing_one_has_no_place(tmp_path: Path) -> None:
    export(export_parquet, write_rig(tmp_path / "one.mcap", frames=3), tmp_path / "out")
    rows = pq.read_table(tmp_path / "out" / "skeletons.parquet").to_pylist()
    for number in range(3):
        of_frame = rows[20 * number : 20 * number + 20]
        assert [row["joint"] for row in of_frame] == list(JOINT_NAMES)
        places = [(row["x_m"], row["y_m"], row["z_m"]) for row in of_frame]
        assert places == [*joints_of(number)[:19], (None, None, None)]
        assert {row["convention"] for row in of_frame} == {"kinect_v1"}
        assert of_frame[18]["state"] == "inferred"


def test_a_pose_with_all_its_fields_is_exported(tmp_path: Path) -> None:
    message = next(one for one in EXAMPLES if type(one).__name__ == "ObjectPose")
    with RecordingWriter(tmp_path / "one.mcap") as writer:
        stamp = {"received_ns": 1, "captured_ns": message.time_ns, "sequence": 6}
        writer.write(POSE.key(SITE, "mug"), POSE.encode(message), **stamp)
    export(export_parquet, tmp_path / "one.mcap", tmp_path / "out")
    (row,) = pq.read_table(tmp_path / "out" / "poses.parquet").to_pylist()
    assert tuple(row["covariance"]) == message.covariance
    assert (row["box_left_px"], row["box_height_px"]) == (10.5, 40.0)
    assert row["rig_z_m"] == message.rig_from_object.translation[2]
    assert (row["visible_fraction"], row["contact"]) == (0.75, "right_hand")


def test_nothing_to_export_is_an_error_that_leaves_nothing(tmp_path: Path) -> None:
    path = write_rig(tmp_path / "one.mcap", frames=1)
    with pytest.raises(RecordingError, match="no poses, labels or skeletons"):
        export(export_parquet, path, tmp_path / "out", Selection(include=("rgbd/*",)))
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("schema", [POSES, JOINTS])
def test_the_page_names_each_column_as_the_file_does(schema: object) -> None:
    page = (ROOT / "docs/exports.md").read_text()
    for column in schema:  # type: ignore[attr-defined]
        assert re.search(rf"`{column.name}`", page), column.name
        assert column.metadata[b"description"]
