"""What a tracker said, or says now, as labels to correct."""

from pathlib import Path

import msgspec
import numpy as np
import pytest
from changed_recordings import write_messages
from inhand_lab.datasets.dataset import Dataset
from inhand_lab.datasets.frame_index import open_frames
from inhand_lab.datasets.observations import track_together
from inhand_lab.datasets.recorded_frames import load_frames
from inhand_lab.evaluation.fold_model import learn_fold_model
from inhand_lab.evaluation.folds import leave_one_out
from inhand_lab.labelling.keyframes import LabellingError
from inhand_lab.labelling.scene import load_scene
from inhand_lab.labelling.suggestions import recorded_suggestions, tracked_suggestions
from inhand_runtime.recording import RecordingWriter, read_recording
from inhand_schemas.keys import Site
from inhand_schemas.messages import ObjectPose
from inhand_schemas.topics import POSE
from inhand_tracker.methods.registry import new_tracker
from keyframed import FRAMES, unlabelled
from waving import messages, write_dataset


def recorded_with_a_tracker(path: Path, camera: str = "camera") -> list[ObjectPose]:
    """A recording in which a tracker said where the box was, but in the fifth frame lost it, and
    left the eighth out."""
    said = [one for one in messages(FRAMES, 0) if isinstance(one, ObjectPose)]
    said = [msgspec.structs.replace(one, camera=camera, confidence=0.7) for one in said]
    said[5] = msgspec.structs.replace(
        said[5], state="lost", confidence=0.0, camera_from_object=None
    )
    del said[8]
    bare = write_messages(path.with_name("bare.mcap"), unlabelled())
    with RecordingWriter(path) as writer:
        for one in read_recording(bare):
            times = {"received_ns": one.received_ns, "captured_ns": one.captured_ns}
            writer.write(one.key, one.payload, sequence=one.sequence, **times)
        for pose in said:
            times = {"received_ns": pose.time_ns, "captured_ns": pose.time_ns}
            key = POSE.key(Site(), "box")
            writer.write(key, POSE.encode(pose), sequence=pose.sequence, **times)
    return said


def test_recorded_estimates_come_in_the_frames_that_they_are_of(tmp_path: Path) -> None:
    path = tmp_path / "tracked.mcap"
    said = {one.sequence: one for one in recorded_with_a_tracker(path)}
    with open_frames(path) as frames:
        found = recorded_suggestions(frames, "box", 3, 12)
    assert np.flatnonzero(~found.given).tolist() == [5 - 3, 8 - 3]
    for index in np.flatnonzero(found.given).tolist():
        pose = said[3 + index].camera_from_object
        assert pose is not None
        np.testing.assert_array_equal(found.translations[index], pose.translation)
        np.testing.assert_array_equal(found.rotations[index], pose.rotation)
        assert found.confidences[index] == 0.7


def test_estimates_by_another_camera_are_left_out(tmp_path: Path) -> None:
    path = tmp_path / "tracked.mcap"
    recorded_with_a_tracker(path, camera="attic")
    with open_frames(path) as frames:
        assert not recorded_suggestions(frames, "box", 0, FRAMES - 1).given.any()


def test_a_recording_without_estimates_of_the_object_is_told(tmp_path: Path) -> None:
    path = tmp_path / "tracked.mcap"
    recorded_with_a_tracker(path)
    with open_frames(path) as frames, pytest.raises(LabellingError, match="no estimates of mug"):
        recorded_suggestions(frames, "mug", 0, 5)


@pytest.fixture(scope="module")
def waved(tmp_path_factory: pytest.TempPathFactory) -> Dataset:
    return write_dataset(tmp_path_factory.mktemp("waved"), frames=40)


def test_a_model_suggests_what_its_tracker_estimates(waved: Dataset) -> None:
    fold = leave_one_out(waved)[0]
    model = learn_fold_model(waved, fold, images=False, fused=True)
    path = waved.path(fold.tested[0])
    frames = load_frames(path, "box")
    _, (track,) = track_together([new_tracker(model)], path, frames, ())
    done: list[int] = []
    found = tracked_suggestions(load_scene(path, "camera"), model, 0, 39, on_frame=done.append)
    assert done == list(range(40))
    assert found.given.all()
    np.testing.assert_array_equal(found.translations, track.translations)
    np.testing.assert_array_equal(found.rotations, track.rotations)
    assert (found.confidences > 0.0).all()
