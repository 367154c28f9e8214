"""Training of a recogniser from recordings of which some show nobody with an object."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from inhand_lab.datasets.dataset import Dataset, DatasetError
from inhand_lab.datasets.generation import GenerationSettings, generate
from inhand_lab.people.joint_sequence import JointSequence
from inhand_lab.training.recogniser_training import NOTHING, learn_recogniser, train_recogniser
from inhand_lab.training.recorded_movements import (
    UsualPoses,
    read_joints,
    read_movement,
)
from inhand_lab.world.idle_people import watch_idle
from inhand_lab.world.simulation import simulate
from inhand_tracker.recognition.recogniser_file import load_recogniser, save_recogniser
from msgspec import structs

ACTIONS = ("drinkFromMug", "hammerNail")


@pytest.mark.exhaustive
def test_recordings_without_an_object_teach_what_no_action_is(tmp_path: Path) -> None:
    """It alone trains a recogniser on labelled and unlabelled recordings."""
    settings = GenerationSettings((*ACTIONS, "sweepFloor"), 6, 5, 240, images=False)
    made = generate(tmp_path / "people", settings, lambda: None)
    entries = tuple(
        structs.replace(one, object=None) if one.interaction == "sweepFloor" else one
        for one in made.entries
    )
    dataset = Dataset(made.folder, entries)
    taught = [one for one in entries if one.participant != "p02"]
    recogniser = train_recogniser(dataset, taught)
    assert recogniser.actions == ACTIONS
    usual = UsualPoses(recogniser.body_poses)
    for entry in entries:
        if entry.participant == "p02":
            movement = read_movement(read_joints(dataset, entry), usual, 3)
            likeliest = recogniser.movements.evidence(movement.features).argmax(axis=1)
            expected = (*ACTIONS, "sweepFloor").index(entry.interaction)
            assert np.mean(likeliest == expected) > 1.0 / 3.0


def drinking(performance: int) -> JointSequence:
    done = simulate("drinkFromMug", 0, 7, 200, performance=performance)
    times_ns = np.rint(np.arange(done.frames) / done.frame_rate * 1e9).astype(np.int64)
    return JointSequence("drinkFromMug", "p00", False, done.joints_in_camera, times_ns)


@pytest.mark.long
def test_one_person_teaches_when_one_object_is_used_and_when_not(tmp_path: Path) -> None:
    """It alone learns from a home's first hour: one person, one object."""
    recogniser = learn_recogniser([drinking(0), drinking(1), drinking(2)])
    save_recogniser(recogniser, tmp_path / "mug.recogniser")
    read = load_recogniser(tmp_path / "mug.recogniser")
    assert read.actions == ("drinkFromMug",)
    usual = UsualPoses(read.body_poses)

    def share_in_use(joints: JointSequence) -> float:
        evidence = read.movements.evidence(read_movement(joints, usual, 3).features)
        return float(np.mean(evidence.argmax(axis=1) == 0))

    assert share_in_use(drinking(3)) > 0.5
    assert share_in_use(watch_idle("walkAbout", 0, 5)) < 0.05


def test_one_recording_by_one_person_is_refused_with_what_to_do() -> None:
    with pytest.raises(DatasetError, match="one recording of 'drinkFromMug' by one person"):
        learn_recogniser([drinking(0), replace(drinking(1), action=NOTHING)])
