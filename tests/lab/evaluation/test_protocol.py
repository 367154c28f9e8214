"""The protocol: who is compared, that the truth stays out, and what is reported."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from inhand_lab.datasets.dataset import Dataset, DatasetError
from inhand_lab.datasets.dataset_writer import DatasetWriter
from inhand_lab.datasets.recorded_frames import load_frames
from inhand_lab.datasets.tracks import empty_track, true_track
from inhand_lab.evaluation.folds import leave_one_out, train_on_one_test_on_other
from inhand_lab.evaluation.pose_errors import ErrorGauge
from inhand_lab.evaluation.protocol import Candidate, Protocol, evaluate
from inhand_lab.evaluation.scoring import Judge
from inhand_lab.evaluation.summary import summarise
from inhand_schemas.messages import ObjectPose, Pose
from inhand_tracker.methods.darby2014.tracker import ParticleTracker
from inhand_tracker.methods.fusion.tracker import FusionTracker
from msgspec import structs
from waving import box, entry_of, messages, waving, write_dataset

EDGES, NONE = ("edges",), ()


def protocol(dataset: Dataset, **changes: object) -> Protocol:
    plain = Protocol(
        dataset, dataset, tuple(leave_one_out(dataset)), ("gd-stable-proximate",), (NONE,), 1
    )
    return dataclasses.replace(plain, **changes)


def test_every_method_terms_and_seed_is_tried_on_every_recording_once(tmp_path: Path) -> None:
    methods = ("g-hand", "gd-hand")
    dataset = write_dataset(tmp_path, frames=20, images=True)
    plan = protocol(dataset, methods=methods, terms=(EDGES, NONE), seeds=2)
    progress: list[int] = []
    trials = evaluate(plan, 1, lambda: progress.append(1))
    expected = {
        (Candidate(method, terms, seed), recording.file)
        for method in methods
        for terms in (EDGES, NONE)
        for seed in range(2)
        for recording in dataset.entries
    }
    assert {(trial.candidate, trial.recording) for trial in trials} == expected
    assert len(trials) == len(progress) == len(expected) == plan.trials() == 24
    assert all(trial.score.frames == 20 for trial in trials)


def test_people_that_were_not_learned_from_are_tracked_well(tmp_path: Path) -> None:
    trials = evaluate(protocol(write_dataset(tmp_path, 4, frames=60)), 1)
    figures = summarise(trials)["gd-stable-proximate"]
    assert figures["vertex_error_cm"] < 6.0
    assert figures["lost_percent"] == 0.0
    assert figures["recovery_s"] is None


def test_processes_and_their_number_change_no_figure(tmp_path: Path) -> None:
    dataset = write_dataset(tmp_path, frames=20)
    plan = protocol(dataset, methods=("gd-hand", "gd-random"), seeds=2)
    assert evaluate(plan, 2) == evaluate(plan, 1)


def test_a_single_fold_is_shared_out_among_processes(tmp_path: Path) -> None:
    trained = write_dataset(tmp_path / "a", frames=20)
    tested = write_dataset(tmp_path / "b", 3, frames=20, first=7)
    folds = tuple(train_on_one_test_on_other(trained, tested))
    plan = dataclasses.replace(protocol(trained), tested=tested, folds=folds)
    here, shared = evaluate(plan, 1), evaluate(plan, 2)
    assert {trial.recording for trial in here} == {entry.file for entry in tested.entries}
    assert sorted(here, key=lambda one: one.recording) == sorted(
        shared, key=lambda one: one.recording
    )


@pytest.mark.parametrize(
    ("method", "kind"), [("gd-stable-proximate", ParticleTracker), ("fusion", FusionTracker)]
)
def test_the_tested_labels_never_reach_a_tracker(
    tmp_path: Path, method: str, kind: type[ParticleTracker] | type[FusionTracker]
) -> None:
    """Wrong labels of the tested person change the errors, and no pose."""
    dataset = write_dataset(tmp_path / "true", frames=20)
    wrong = write_with_labels_moved(tmp_path / "wrong", frames=20, shift_m=0.5)
    folds = train_on_one_test_on_other(dataset, dataset)
    poses: list[list[np.ndarray]] = []
    original = kind.step_body

    def noting(self: object, *arguments: object) -> object:
        estimate = original(self, *arguments)
        poses[-1].append(estimate.translation)
        return estimate

    errors = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(kind, "step_body", noting)
        for tested in (dataset, wrong):
            poses.append([])
            plan = protocol(dataset, tested=tested, folds=tuple(folds), methods=(method,))
            errors.append(summarise(evaluate(plan, 1))[method]["vertex_error_cm"])
    assert len(poses[0]) == 3 * 20
    np.testing.assert_array_equal(poses[0], poses[1])
    assert errors[1] - errors[0] > 40.0


def write_with_labels_moved(folder: Path, frames: int, shift_m: float) -> Dataset:
    dataset = write_dataset(folder / "before", frames=frames)
    writer = DatasetWriter(folder / "after")
    writer.add_shape(box())
    for seed, entry in enumerate(dataset.entries):
        moved = (
            moved_label(message, shift_m) if isinstance(message, ObjectPose) else message
            for message in messages(frames, seed)
        )
        writer.add_recording(entry, moved)
    return writer.finish({"name": "moved"})


def moved_label(label: ObjectPose, shift_m: float) -> ObjectPose:
    pose = label.camera_from_object
    assert pose is not None
    x, y, z = pose.translation
    return structs.replace(label, camera_from_object=Pose((x + shift_m, y, z), pose.rotation))


def test_a_lost_object_counts_at_its_last_pose_and_before_the_first_as_lost(tmp_path: Path) -> None:
    dataset = write_dataset(tmp_path, 1, frames=10)
    frames = load_frames(dataset.path(dataset.entries[0]), "box")
    judge = Judge(frames, waving(10, 0)[0], ErrorGauge(box()))
    true = true_track(frames)
    assert judge.score(empty_track(10)) is None
    late = empty_track(10)
    late.translations[4:], late.rotations[4:] = true.translations[4:], true.rotations[4:]
    score = judge.score(late)
    assert score is not None
    assert score.vertex_error_m == pytest.approx(0.0, abs=1e-12)
    assert score.close_share == pytest.approx(0.6)
    assert score.area_under_curve == pytest.approx(0.6)
    assert score.lost_share == pytest.approx(0.4)
    assert score.recoveries.losses == 1
    assert score.recoveries.seconds == pytest.approx(4 / 30.0, abs=1e-3)
    early = empty_track(10)
    early.translations[:4], early.rotations[:4] = true.translations[:4], true.rotations[:4]
    held = judge.score(early)
    assert held is not None
    expected = np.linalg.norm(true.translations - true.translations[[*range(4), *[3] * 6]], axis=1)
    assert held.translation_m == pytest.approx(expected.mean())
    assert held.lost_share == pytest.approx(0.6)


def test_an_unlabelled_tested_recording_is_refused_with_the_mend(tmp_path: Path) -> None:
    trained = write_dataset(tmp_path / "a", frames=10)
    writer = DatasetWriter(tmp_path / "b")
    writer.add_shape(box())
    unlabelled = (one for one in messages(10, 5) if not isinstance(one, ObjectPose))
    writer.add_recording(entry_of("p5"), unlabelled)
    tested = writer.finish({"name": "unlabelled"})
    folds = tuple(train_on_one_test_on_other(trained, tested))
    plan = dataclasses.replace(protocol(trained), tested=tested, folds=folds)
    with pytest.raises(DatasetError, match=r"p5\.mcap: no frame has both a pose and a label"):
        evaluate(plan, 1)
