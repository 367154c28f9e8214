"""Bodies and frames in, recorded poses out, through real processes."""

import json
import signal
from collections.abc import Sequence
from pathlib import Path

import inhand_recorder
import numpy as np
import pytest
from fetched_weights import use_weights
from inhand_lab.datasets.dataset import Dataset, DatasetEntry, load_dataset
from inhand_lab.datasets.observations import observe
from inhand_lab.datasets.recorded_frames import load_frames
from inhand_lab.training.model_training import train
from inhand_recorder.attachments import meshes_in
from inhand_recorder.verification import verify_recording
from inhand_runtime.recording import read_recording
from inhand_schemas.messages import ObjectPose
from inhand_schemas.topics import POSE, RGBD, SKELETONS
from inhand_tracker.methods.registry import DEFAULT_METHOD, METHODS, new_tracker
from inhand_tracker.model.model import Model
from inhand_tracker.model.model_file import load_model, save_model
from real_data import DATA, needs_real_data
from running_rig import RunningRig, eventually

from inhand.__main__ import main

SEED = 5


def simulated(folder: Path, *interactions: str, images: bool = False, frames: int = 90) -> Dataset:
    chosen = interactions or ("drinkFromMug",)
    arguments = ["--interactions", *chosen, "--participants", "4", "--seed", "1"]
    arguments += ["--frames", str(frames), *([] if images else ["--no-images"])]
    assert main(["simulate", str(folder), *arguments]) == 0
    return load_dataset(folder)


@pytest.fixture(scope="module")
def drinkers(tmp_path_factory: pytest.TempPathFactory) -> Dataset:
    """Four people with a mug, without images."""
    return simulated(tmp_path_factory.mktemp("drinkers") / "people")


def tracked_live(
    rig: RunningRig, recording: Path, *models: Path, left_handed: bool = False
) -> Path:
    """Replay a recording through capture, tracker and recorder, with every frame tracked; returns
    what was recorded."""
    out = rig.folder / "out"
    frames = sum(1 for _ in read_recording(recording, streams=(SKELETONS.stream,)))
    rig.configure(
        f'[capture.front]\nsource = "replay"\nwait_for_reader_s = 60\n'
        f'[capture.front.options]\nfile = "{recording}"\n'
        f'[tracker.follower]\ncamera = "front"\nseed = {SEED}\nevery_frame = true\n'
        f"models = {json.dumps([str(model) for model in models])}\n"
        f"left_handed = {json.dumps(left_handed)}\n"
        f'[recorder.disk]\nfolder = "{out}"'
    )
    up = rig.inhand("up", "--config", rig.config)
    up.said("capture front ended with exit code 0")
    keys = [f"inhand/@v1/rig/pose/{load_model(model).shape.name}" for model in models]
    eventually(
        "a pose of every object for every skeleton",
        lambda: all(rig.counted("follower", key, "published") == frames for key in keys),
    )
    assert up.stop(signal.SIGTERM) == 0
    (recorded,) = out.glob("*.mcap")
    return recorded


def recorded_poses(recording: Path) -> list[ObjectPose]:
    messages = [one.message() for one in read_recording(recording, streams=(POSE.stream,))]
    return [message for message in messages if isinstance(message, ObjectPose)]


def assert_retracked_as_live(rig: RunningRig, recorded: Path) -> None:
    """Track what was recorded live again, without a rig, by the settings of its tracker."""
    live = recorded_poses(recorded)
    again = rig.folder / "again"
    arguments = ["--config", str(rig.config), "-o", str(again), "--jobs", "1"]
    assert main(["recording", "retrack", str(recorded), *arguments]) == 0
    both = recorded_poses(again / recorded.name)
    new = [pose for pose in both if pose.object.endswith("_follower")]
    assert [pose for pose in both if pose not in new] == live
    for one, other in zip(sorted(new, key=by_frame), sorted(live, key=by_frame), strict=True):
        assert one.object == f"{other.object}_follower"
        assert (one.sequence, one.time_ns, one.state) == (
            other.sequence,
            other.time_ns,
            other.state,
        )
        assert one.camera_from_object is not None
        assert other.camera_from_object is not None
        for part in ("translation", "rotation"):
            values = [getattr(pose.camera_from_object, part) for pose in (one, other)]
            np.testing.assert_allclose(*values, atol=1e-9)


def by_frame(pose: ObjectPose) -> tuple[int, str]:
    return pose.sequence, pose.object


def assert_live_equals_offline(
    rig: RunningRig, dataset: Dataset, tested: DatasetEntry, objects: Sequence[str]
) -> Path:
    """Track objects in one person's hands, in a recording that no model was learned from; returns
    what was recorded meanwhile."""
    models = {}
    for name in objects:
        others = [e for e in dataset.entries if e.object == name and e != tested]
        models[name] = train(dataset, others)
        save_model(models[name], rig.folder / f"{name}.model")
    paths = [rig.folder / f"{name}.model" for name in objects]
    left_handed = tested.handedness == "left"
    recorded = tracked_live(rig, dataset.path(tested), *paths, left_handed=left_handed)
    live = recorded_poses(recorded)
    frames = load_frames(dataset.path(tested), tested.object)
    for name, model in models.items():
        tracker = new_tracker(model, DEFAULT_METHOD, left_handed=left_handed, seed=SEED)
        needs = METHODS[DEFAULT_METHOD].needs(METHODS[DEFAULT_METHOD].usual_terms)
        offline = [seen.show(tracker) for seen in observe(dataset.path(tested), frames, needs)]
        poses = [pose for pose in live if pose.object == name]
        assert [pose.time_ns for pose in poses] == [frame.time_ns for frame in frames]
        for pose, estimate in zip(poses, offline, strict=True):
            told = pose.camera_from_object
            assert told is not None
            np.testing.assert_allclose(told.translation, estimate.translation, atol=1e-9)
            np.testing.assert_allclose(told.rotation, estimate.rotation, atol=1e-9)
    return recorded


@pytest.mark.long
@pytest.mark.parametrize("handedness", ["right", "left"])
def test_live_poses_equal_the_offline_evaluations(
    rig: RunningRig, drinkers: Dataset, handedness: str
) -> None:
    tested = next(entry for entry in drinkers.entries if entry.handedness == handedness)
    assert_live_equals_offline(rig, drinkers, tested, ["mug"])


@pytest.mark.long
def test_images_that_come_live_weigh_as_they_do_offline(rig: RunningRig, tmp_path: Path) -> None:
    dataset = simulated(tmp_path / "people", images=True, frames=60)
    tested = next(entry for entry in dataset.entries if entry.handedness == "right")
    assert_retracked_as_live(rig, assert_live_equals_offline(rig, dataset, tested, ["mug"]))


@pytest.mark.long
def test_two_objects_are_tracked_live_as_each_is_offline(rig: RunningRig, tmp_path: Path) -> None:
    dataset = simulated(tmp_path / "people", "drinkFromMug", "putOnGlasses")
    tested = next(entry for entry in dataset.entries if entry.handedness == "right")
    assert_live_equals_offline(rig, dataset, tested, ["mug", "glasses"])


@pytest.mark.long
@needs_real_data
def test_a_real_golf_swing_tracked_live_equals_the_offline_evaluation(
    rig: RunningRig, tmp_path: Path
) -> None:
    swings = sorted(str(path) for path in (DATA / "motion").glob("golf_*.npz"))
    assert main(["import", "motion", *swings, str(tmp_path / "golf")]) == 0
    dataset = load_dataset(tmp_path / "golf")
    assert_live_equals_offline(rig, dataset, dataset.entries[1], ["golf_club"])


@pytest.mark.long
@needs_real_data
def test_a_real_kinect_tennis_swing_with_depth_loses_no_frame(
    rig: RunningRig, tmp_path: Path, drinkers: Dataset
) -> None:
    model: Model = train(drinkers, drinkers.entries)
    save_model(model, tmp_path / "mug.model")
    trial = DATA / "utd-mhad" / "a15_s1_t1_skeleton.mat"
    assert main(["import", "utd-mhad", str(trial), str(tmp_path / "tennis")]) == 0
    tennis = load_dataset(tmp_path / "tennis")
    (entry,) = tennis.entries
    recorded = tracked_live(rig, tennis.path(entry), tmp_path / "mug.model")
    counts = dict.fromkeys((SKELETONS.stream, RGBD.stream, POSE.stream), 0)
    for one in read_recording(recorded, streams=counts):
        counts[one.topic.stream] += 1
    published = sum(1 for _ in read_recording(tennis.path(entry), streams=(SKELETONS.stream,)))
    assert counts == dict.fromkeys(counts, published)
    assert verify_recording(recorded) == []


@pytest.mark.long
def test_the_demonstration_tracks_a_stranger_and_loses_nothing(tmp_path: Path) -> None:
    result = tmp_path / "demo.json"
    arguments = ["--folder", str(tmp_path / "demo"), "--json", str(result)]
    assert main(["demo", *arguments]) == 0
    told = json.loads(result.read_text())
    assert set(told["topics"]) == {"info", "label", "pose", "rgbd", "skeletons"}
    assert all(topic["lost"] == 0 for topic in told["topics"].values())
    # A busy machine draws fewer frames in the twelve seconds than thirty a second.
    published = told["topics"]["skeletons"]["published"]
    assert told["topics"]["pose"]["recorded"] + told["skipped_frames"] == published > 180
    assert told["topics"]["pose"]["recorded"] > 60
    assert told["vertex_error_cm"] < 12.0
    assert Path(told["picture"]).stat().st_size > 10_000
    assert verify_recording(Path(told["recording"])) == []
    stands_alone(Path(told["recording"]), tmp_path / "bop")


@pytest.mark.exhaustive
def test_the_demonstration_of_three_cameras_tracks_by_all_and_loses_nothing(
    tmp_path: Path,
) -> None:
    result = tmp_path / "demo.json"
    arguments = ["--cameras", "3", "--seconds", "3", "--folder", str(tmp_path / "demo")]
    assert main(["demo", *arguments, "--json", str(result)]) == 0
    told = json.loads(result.read_text())
    assert all(topic["lost"] == 0 for topic in told["topics"].values())
    assert told["topics"]["info"]["recorded"] == 3
    assert told["topics"]["skeletons"]["recorded"] == told["topics"]["skeletons"]["published"]
    assert told["topics"]["pose"]["recorded"] > 10
    assert told["vertex_error_cm"] < 6.0
    seen = {one.name for one in read_recording(Path(told["recording"]), streams=("rgbd",))}
    assert seen == {"front", "left", "right"}


def stands_alone(path: Path, bop: Path) -> None:
    """A live rig's recording has the object's mesh, and needs nothing else to be exported."""
    with inhand_recorder.open(path) as recording:
        assert list(meshes_in(recording.attachments())) == ["mug"]
        first_ns = int(recording["pose/mug"].received_ns[10])
        start_s = (first_ns - recording.start_ns) / 1e9
    words = ["recording", "export", str(path), "--to", "bop", "-o", str(bop)]
    times = ["--start", str(start_s), "--end", str(start_s + 0.5)]
    assert main([*words, "--exclude", "label/*", *times]) == 0
    scene = json.loads((bop / "test" / "000001" / "scene_gt_info.json").read_text())
    seen = [one for of_image in scene.values() for one in of_image]
    assert len(seen) > 2
    assert all(one["px_count_all"] > 100 for one in seen)


@pytest.mark.long
def test_the_demonstration_finds_the_person_in_the_pictures_as_with_a_camera(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    use_weights(monkeypatch, "full")
    result = tmp_path / "demo.json"
    arguments = ["--camera-like", "--folder", str(tmp_path / "demo"), "--json", str(result)]
    main(["demo", *arguments])
    told = json.loads(result.read_text())
    # A busy machine may lose pictures on their way to the recorder, and says so.
    assert 60 < told["topics"]["skeletons"]["published"] <= told["topics"]["rgbd"]["published"]
    assert told["vertex_error_cm"] < 12.0


def test_a_damaged_model_is_one_line_and_nothing_starts(
    rig: RunningRig, tmp_path: Path, drinkers: Dataset
) -> None:
    model = tmp_path / "mug.model"
    save_model(train(drinkers, drinkers.entries), model)
    model.write_bytes(model.read_bytes()[: model.stat().st_size // 2])
    rig.configure(f'[tracker.mug]\nmodel = "{model}"')
    ended = rig.done("tracker", "--config", rig.config)
    assert ended.popen.returncode == 2
    (line,) = ended.stderr.splitlines()
    assert f"{model} is damaged" in line
    assert "inhand train" in line


def test_a_tracker_without_a_model_says_what_to_write(rig: RunningRig) -> None:
    rig.configure("[tracker.mug]")
    ended = rig.done("tracker", "--config", rig.config)
    assert ended.popen.returncode == 2
    (line,) = ended.stderr.splitlines()
    assert "[tracker.mug] names no model" in line


def test_a_mesh_without_marked_vertices_stops_training_with_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    dataset = simulated(tmp_path / "people")
    description = dataset.folder / "objects" / "mug" / "object.toml"
    description.write_text('name = "mug"\n')
    capsys.readouterr()
    assert main(["train", str(dataset.folder), "-o", str(tmp_path / "mug.model")]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert "marks 0 vertices" in line
    assert "marked_vertices = [[x, y, z]" in line
