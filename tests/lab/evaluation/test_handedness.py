"""The dominant hand that a dataset names is honoured from training to evaluation.

A dataset of left-handed people is made as the mirror image of one of right-handed people, so that
everything must come out the same.
"""

from dataclasses import replace
from pathlib import Path

import msgspec
import numpy as np
import pytest
from inhand_lab.datasets.dataset import Dataset, DatasetEntry
from inhand_lab.datasets.dataset_writer import DatasetWriter
from inhand_lab.evaluation.folds import leave_one_out, train_on_one_test_on_other
from inhand_lab.evaluation.protocol import Protocol, evaluate
from inhand_lab.sensing.cameras import KINECT
from inhand_lab.training.model_training import entries_for, train
from inhand_lab.world.messages import camera_info, shape_of
from inhand_lab.world.simulation import Simulation, simulate
from inhand_schemas.messages import Message, ObjectPose, Person, Skeletons
from inhand_tracker.body.skeleton import mirror_joints, mirror_pose
from inhand_tracker.wire.poses import pose_message

FRAMES, FRAME_RATE = 90, 15.0
FILMED = replace(KINECT, frame_rate=FRAME_RATE)
METHODS = ("g-hand", "gd-random", "gd-stable-proximate")


def messages(simulation: Simulation, *, mirrored: bool) -> list[Message]:
    joints = simulation.true_joints_in_camera
    poses = simulation.translations, simulation.rotations
    if mirrored:
        normal = np.array(simulation.object_model.mirror_normal)
        joints, poses = mirror_joints(joints), mirror_pose(*poses, normal)
    told: list[Message] = [camera_info(simulation.intrinsics, FRAME_RATE)]
    for frame in range(FRAMES):
        moment = {"sequence": frame, "time_ns": 1 + round(frame * 1e9 / FRAME_RATE)}
        person = Person(
            id=0,
            joints=tuple(map(tuple, joints[frame].tolist())),
            states=("tracked",) * 20,
            confidences=(1.0,) * 20,
        )
        told.append(Skeletons(**moment, people=(person,)))
        told.append(
            ObjectPose(
                **moment,
                object=simulation.object_model.name,
                camera="camera",
                state="tracked",
                confidence=1.0,
                camera_from_object=pose_message(poses[0][frame], poses[1][frame]),
            )
        )
    return told


def dataset_of(folder: Path, *, left_handed: bool) -> Dataset:
    """Three people who drink with the hand that is asked for."""
    writer = DatasetWriter(folder)
    for participant in range(3):
        simulation = simulate("drinkFromMug", participant, 1, FRAMES, FILMED)
        mirrored = (simulation.person.handedness == "left") != left_handed
        shape = shape_of(simulation.object_model)
        writer.add_shape(shape)
        entry = DatasetEntry(
            file=f"recordings/p{participant}.mcap",
            interaction="drinkFromMug",
            object=shape.name,
            participant=f"p{participant}",
            handedness="left" if left_handed else "right",
            frame_rate=FRAME_RATE,
        )
        writer.add_recording(entry, messages(simulation, mirrored=mirrored))
    return writer.finish({"name": "test"})


@pytest.fixture(scope="module")
def both(tmp_path_factory: pytest.TempPathFactory) -> tuple[Dataset, Dataset]:
    """The right-handed people, and their mirror images."""
    folder = tmp_path_factory.mktemp("hands")
    return (
        dataset_of(folder / "right", left_handed=False),
        dataset_of(folder / "left", left_handed=True),
    )


def again(dataset: Dataset) -> Dataset:
    """The same dataset, as another one to test on."""
    return Dataset(dataset.folder, dataset.entries)


def errors(trained: Dataset, tested: Dataset) -> list[float]:
    folds = (
        leave_one_out(trained) if trained is tested else train_on_one_test_on_other(trained, tested)
    )
    protocol = Protocol(trained, tested, tuple(folds), METHODS, ((),), 1)
    return [trial.score.vertex_error_m for trial in evaluate(protocol, processes=1)]


def test_training_on_left_handed_people_gives_the_right_handed_mapping(
    both: tuple[Dataset, Dataset],
) -> None:
    right, left = (train(dataset, entries_for(dataset)).mapping for dataset in both)
    np.testing.assert_allclose(left.body_poses, right.body_poses, atol=1e-5)
    np.testing.assert_allclose(left.translations, right.translations, atol=1e-5)
    dots = np.abs(np.sum(left.rotations * right.rotations, axis=-1))
    np.testing.assert_allclose(dots, 1.0, atol=1e-5)
    np.testing.assert_array_equal(left.proximate_part, right.proximate_part)


def test_left_handed_people_are_evaluated_as_well_as_right_handed_ones(
    both: tuple[Dataset, Dataset],
) -> None:
    right, left = both
    np.testing.assert_allclose(errors(left, left), errors(right, right), atol=1e-3)


@pytest.fixture(scope="module")
def left_after_right(both: tuple[Dataset, Dataset]) -> list[float]:
    """Errors on the left-handed people after training on the right-handed ones."""
    right, left = both
    return errors(right, left)


def test_right_handed_people_teach_how_left_handed_ones_do_it(
    both: tuple[Dataset, Dataset], left_after_right: list[float]
) -> None:
    right, _ = both
    np.testing.assert_allclose(left_after_right, errors(right, again(right)), atol=1e-3)


def test_the_wrong_hand_is_noticed(
    both: tuple[Dataset, Dataset], left_after_right: list[float]
) -> None:
    """Were handedness not used, the mirrored people would be tracked as badly as this."""
    right, left = both
    entries = tuple(msgspec.structs.replace(entry, handedness="right") for entry in left.entries)
    wrong = Dataset(left.folder, entries)
    assert np.mean(errors(right, wrong)) > 2.0 * np.mean(left_after_right)
