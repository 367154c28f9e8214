"""Training of a recogniser from recordings of which some show nobody with an object."""

from pathlib import Path

import numpy as np
import pytest
from inhand_lab.datasets.dataset import Dataset
from inhand_lab.datasets.generation import GenerationSettings, generate
from inhand_lab.training.recogniser_training import train_recogniser
from inhand_lab.training.recorded_movements import (
    UsualPoses,
    read_joints,
    read_movement,
)
from msgspec.structs import replace

ACTIONS = ("drinkFromMug", "hammerNail")


@pytest.mark.long
def test_recordings_without_an_object_teach_what_no_action_is(tmp_path: Path) -> None:
    """It alone trains a recogniser on labelled and unlabelled recordings."""
    settings = GenerationSettings((*ACTIONS, "sweepFloor"), 6, 5, 240, images=False)
    made = generate(tmp_path / "people", settings, lambda: None)
    entries = tuple(
        replace(one, object=None) if one.interaction == "sweepFloor" else one
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
