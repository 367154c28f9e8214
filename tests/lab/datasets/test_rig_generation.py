"""Datasets of people whom several cameras see."""

from pathlib import Path

import numpy as np
import pytest
from inhand_lab.datasets.dataset import Dataset, load_dataset
from inhand_lab.datasets.dataset_writer import write_received
from inhand_lab.datasets.generation import handover_messages
from inhand_lab.datasets.labelled_sequence import labelled_sequence
from inhand_lab.datasets.recorded_frames import load_frames
from inhand_lab.world.handover import simulate_handover
from inhand_lab.world.rigs import RigSimulation, simulate_rig
from inhand_recorder.inspection import inspect_recording
from inhand_runtime.recording import read_recording
from inhand_schemas.messages import CameraInfo, ObjectPose, Skeletons

from inhand.__main__ import main

FRAMES = 120


@pytest.fixture(scope="module")
def rig() -> RigSimulation:
    return simulate_rig("drinkFromMug", 0, 6, FRAMES, 3)


@pytest.fixture(scope="module")
def dataset(tmp_path_factory: pytest.TempPathFactory) -> Dataset:
    folder = tmp_path_factory.mktemp("rig") / "people"
    options = ("--interactions", "drinkFromMug", "--participants", "1", "--seed", "6")
    more = ("--frames", str(FRAMES), "--no-images", "--cameras", "3")
    assert main(["simulate", str(folder), *options, *more]) == 0
    return load_dataset(folder)


def test_a_recording_holds_all_cameras_with_their_poses_clocks_and_lost_frames(
    dataset: Dataset, rig: RigSimulation
) -> None:
    (entry,) = dataset.entries
    assert entry.cameras == ("front", "left", "right")
    assert "cameras = 3" in (dataset.folder / "dataset.toml").read_text()
    path = dataset.path(entry)
    infos = {
        one.name: message
        for one in read_recording(path, streams=("info",))
        if isinstance(message := one.message(), CameraInfo)
    }
    skeletons = list(read_recording(path, streams=("skeletons",)))
    assert {one.name for one in skeletons} == set(rig.names)
    for number, view in enumerate(rig.views):
        placed = infos[view.name].rig_from_camera.translation
        assert placed == pytest.approx(view.rig_from_camera.translation)
        kept = np.flatnonzero(~view.dropped)
        mine = [one for one in skeletons if one.name == view.name]
        assert [one.sequence for one in mine] == kept.tolist()
        stamps = np.diff([one.captured_ns for one in mine])
        assert np.array_equal(stamps, np.diff(rig.stamps_ns(number)[kept]))
        ahead = [1e-9 * (one.received_ns - one.captured_ns) for one in mine]
        assert np.allclose(ahead, view.clock.offset_s, atol=1e-3)


def test_readers_of_one_camera_take_the_first_or_the_one_that_is_named(
    dataset: Dataset, rig: RigSimulation
) -> None:
    (entry,) = dataset.entries
    joints = labelled_sequence(dataset, entry).joints
    expected = rig.cameras[0].joints_in_camera[~rig.dropped[0]]
    seen = np.isfinite(joints).all(axis=2)
    assert np.allclose(joints[seen], expected[seen])
    left = load_frames(dataset.path(entry), "mug", "left")
    kept = np.flatnonzero(~rig.dropped[1])
    assert len(left) == len(kept)
    for frame, number in zip(left, kept, strict=True):
        assert frame.label is not None
        assert frame.label.camera == "left"
        pose = frame.label.camera_from_object
        assert pose is not None
        assert np.allclose(pose.translation, rig.cameras[1].translations[number])


def test_labels_of_several_cameras_on_one_key_are_no_losses(dataset: Dataset) -> None:
    info = inspect_recording(dataset.path(dataset.entries[0]))
    (labels,) = (key for key in info.keys if key.type == "ObjectPose")
    assert labels.messages > 2 * FRAMES
    assert labels.lost == 0


@pytest.mark.parametrize(
    ("options", "line"),
    [
        (["--cameras", "5"], "--cameras is 1 to 4"),
        (["--cameras", "2", "--frames", "1"], "2 --frames or more"),
        (["--roaming", "--interactions", "pourCream"], "nobody walks about in 'pourCream'"),
        (["--roaming", "--people", "varied"], "only usual people walk about"),
        (["--cameras", "2", "--bodies", "x"], "--cameras and --roaming are for a dataset"),
    ],
)
def test_a_rig_that_cannot_be_is_refused_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], options: list[str], line: str
) -> None:
    assert main(["simulate", str(tmp_path / "out"), *options]) == 2
    assert line in " ".join(capsys.readouterr().err.split())


def test_a_handover_is_recorded_with_whom_each_camera_sees_and_who_has_the_mug(
    tmp_path: Path,
) -> None:
    handover = simulate_handover(2, cameras=2, frames=200)
    path = tmp_path / "handover.mcap"
    write_received(path, handover_messages(handover, images=False))
    sent = list(read_recording(path, streams=("skeletons", "label")))
    left = [one.message() for one in sent if one.name == "left"]
    kept = np.flatnonzero(~handover.rig.dropped[1])
    for frame, message in zip(kept, left, strict=True):
        assert isinstance(message, Skeletons)
        assert message.people == handover.people(1, frame)
    labels = [one.message() for one in sent if one.name == "mug"]
    holders = {one.person for one in labels if isinstance(one, ObjectPose)}
    assert {0, 1} <= holders
