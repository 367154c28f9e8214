"""A video of a camera's pictures, decoded by OpenCV, with the object's outline where it is."""

from pathlib import Path

import cv2
import numpy as np
import pytest
import trimesh
from exported import export
from inhand_recorder.conversion import Selection
from inhand_runtime.errors import InhandError
from inhand_runtime.recording import RecordingWriter, read_recording
from inhand_runtime.recording.copying import copy_message
from small_rig import CAMERA, FRAME_NS, pose_of, write_rig

from inhand.exports.video import export_video


@pytest.fixture
def objects(tmp_path: Path) -> Path:
    """A folder with the mesh of a mug, which is a cube of 8 cm."""
    (tmp_path / "objects/mug").mkdir(parents=True)
    trimesh.creation.box((0.08, 0.08, 0.08)).export(tmp_path / "objects/mug/mesh.ply")
    return tmp_path / "objects"


def test_pictures_have_their_times_and_the_outline_is_around_the_object(
    tmp_path: Path, objects: Path
) -> None:
    source = write_rig(tmp_path / "one.mcap")
    chosen = Selection(exclude=("pose/*",))
    counts = export(export_video, source, tmp_path / "a.mp4", chosen, objects=objects)
    assert counts == {"frames": 10, "outlines": 10, "damaged images": 0}
    video = cv2.VideoCapture(str(tmp_path / "a.mp4"))
    for number in range(10):
        shown, bgr = video.read()
        assert shown
        assert video.get(cv2.CAP_PROP_POS_MSEC) == pytest.approx(number * FRAME_NS / 1e6, abs=0.1)
        # The pictures have red alone, and a line in the truth's colour is green.
        rows, columns = np.nonzero(bgr[..., 1] > 110)
        x, y, z = pose_of(number).translation
        u, v = CAMERA.fx * x / z + CAMERA.cx, CAMERA.fy * y / z + CAMERA.cy
        assert (columns.min() + columns.max()) / 2 == pytest.approx(u, abs=2.0)
        assert (rows.min() + rows.max()) / 2 == pytest.approx(v, abs=2.0)
        assert 5 <= columns.max() - columns.min() <= 16
    assert not video.read()[0]


def test_without_poses_no_mesh_is_needed_and_with_them_a_missing_one_is_said(
    tmp_path: Path, objects: Path
) -> None:
    source = write_rig(tmp_path / "one.mcap", frames=2)
    chosen = Selection(include=("rgbd/*", "info/*"))
    counts = export(export_video, source, tmp_path / "a.mp4", chosen)
    assert counts == {"frames": 2, "outlines": 0, "damaged images": 0}
    with pytest.raises(InhandError, match="the shape of mug is not known: --objects FOLDER"):
        export(export_video, source, tmp_path / "b.mp4")
    (objects / "mug").rename(objects / "cup")
    with pytest.raises(InhandError, match="has no folder mug"):
        export(export_video, source, tmp_path / "b.mp4", objects=objects)
    assert sorted(one.name for one in tmp_path.iterdir()) == ["a.mp4", "objects", "one.mcap"]


def test_a_mesh_that_is_attached_to_the_recording_needs_no_folder(
    tmp_path: Path, objects: Path
) -> None:
    path = tmp_path / "with_mesh.mcap"
    with RecordingWriter(path) as writer:
        for message in read_recording(write_rig(tmp_path / "one.mcap", frames=2)):
            copy_message(writer, message)
        data = (objects / "mug/mesh.ply").read_bytes()
        writer.add_attachment("objects/mug/mesh.ply", "application/ply", data, received_ns=1)
    assert export(export_video, path, tmp_path / "a.mp4")["outlines"] == 4
