"""A folder as in the TUM RGB-D benchmark: read as its own tools read it."""

from pathlib import Path

import cv2
import numpy as np
import pytest
from exported import export
from inhand_recorder.conversion import Selection
from inhand_runtime.pixels import decode_colour, encode_colour
from inhand_runtime.recording import RecordingError
from small_rig import CAMERA, FRAME_NS, START_NS, colour_of, depth_of, pose_of, write_rig

from inhand.exports.tum import export_tum


def read_list(path: Path) -> dict[str, list[str]]:
    """The fields of each line by its time, as the benchmark's ``associate.py`` reads them."""
    lines = [line.split() for line in path.read_text().splitlines() if not line.startswith("#")]
    return {time: fields for time, *fields in lines}


def test_pictures_depth_and_poses_are_exactly_those_of_the_recording(tmp_path: Path) -> None:
    out = tmp_path / "tum"
    counts = export(export_tum, write_rig(tmp_path / "one.mcap"), out)
    assert counts == {"frames": 10, "poses": 10, "damaged images": 0}
    colours, depths = read_list(out / "rgb.txt"), read_list(out / "depth.txt")
    truth, pairs = read_list(out / "groundtruth.txt"), read_list(out / "associations.txt")
    times = [START_NS + number * FRAME_NS for number in range(10)]
    for listed in (colours, depths, truth, pairs):
        assert [round(int(t.replace(".", ""))) for t in listed] == times
    for number, time in enumerate(colours):
        assert pairs[time] == [colours[time][0], time, depths[time][0]]
        depth = cv2.imread(str(out / depths[time][0]), cv2.IMREAD_UNCHANGED)
        np.testing.assert_array_equal(depth, depth_of(number))
        bgr = cv2.imread(str(out / colours[time][0]), cv2.IMREAD_UNCHANGED)
        decoded = decode_colour(encode_colour(colour_of(number)))
        np.testing.assert_array_equal(bgr[..., ::-1], decoded)
        pose = pose_of(number)
        w, *xyz = pose.rotation
        np.testing.assert_array_equal(np.float64(truth[time]), [*pose.translation, *xyz, w])
    shown = next(iter(read_list(out / "camera.txt").items()))
    assert [float(one) for one in (shown[0], *shown[1])] == [
        *(CAMERA.fx, CAMERA.fy, CAMERA.cx, CAMERA.cy, CAMERA.width, CAMERA.height),
        1000.0,
    ]
    assert "from label/mug" in (out / "groundtruth.txt").read_text()


def test_tracked_poses_are_taken_without_labels_and_lost_ones_left_out(tmp_path: Path) -> None:
    path = write_rig(tmp_path / "one.mcap")
    start_ns = START_NS + 3 * FRAME_NS
    chosen = Selection(exclude=("label/*",), start_ns=start_ns)
    counts = export(export_tum, path, tmp_path / "tum", chosen)
    assert counts == {"frames": 7, "poses": 5, "damaged images": 0}
    assert len(read_list(tmp_path / "tum/groundtruth.txt")) == 5
    assert "from pose/mug" in (tmp_path / "tum/groundtruth.txt").read_text()


def test_what_cannot_be_exported_is_said_and_leaves_nothing(tmp_path: Path) -> None:
    path = write_rig(tmp_path / "one.mcap", frames=2)
    for more, chosen, said in (
        ({"camera": "hall"}, Selection(), "there is no camera 'hall'; there are: front"),
        ({}, Selection(exclude=("rgbd/*",)), "choose one camera .* there are: none"),
        ({"object": "cup"}, Selection(), "there is no object 'cup'; there are: mug"),
        ({}, Selection(end_ns=START_NS - 1), "no frame of front in this time"),
    ):
        with pytest.raises(RecordingError, match=said):
            export(export_tum, path, tmp_path / "tum", chosen, **more)
    assert [one.name for one in tmp_path.iterdir()] == ["one.mcap"]
