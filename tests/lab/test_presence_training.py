"""What is learned of how objects are seen, from a small simulated world with images."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from inhand_lab.generation import generate
from inhand_lab.presence_training import learn_presence
from inhand_lab.training import train
from inhand_tracker.model_file import save_model
from inhand_tracker.presence import usual_presence
from inhand_tracker.recogniser_file import load_recogniser

from inhand.__main__ import main

pytestmark = [pytest.mark.long, pytest.mark.timeout(900)]

ACTIONS = ("sweepFloor", "drinkFromMug")


def test_objects_are_seen_better_where_they_are(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    people = generate(tmp_path / "set", ACTIONS, 2, 3, 90, images=True, on_progress=lambda: None)
    models = [
        train(people, [e for e in people.entries if e.interaction == action]) for action in ACTIONS
    ]
    presence = learn_presence(people, people.entries, ACTIONS, models)
    assert (presence.present > presence.absent + 10.0).all()
    assert not np.allclose(presence.absent, usual_presence(2).absent)
    blind = replace(people, entries=())
    untold = learn_presence(blind, (), ACTIONS, models)
    np.testing.assert_allclose(untold.present, usual_presence(2).present)

    files = [tmp_path / f"{action}.model" for action in ACTIONS]
    for model, file in zip(models, files, strict=True):
        save_model(model, file)
    learned = tmp_path / "actions.recogniser"
    command = ["train", str(people.folder), "-o", str(learned), "--recogniser", "--models"]
    assert main([*command, *map(str, files)]) == 0
    np.testing.assert_allclose(load_recogniser(learned).presence.present, presence.present)
    capsys.readouterr()
    assert main([*command, str(files[0])]) == 2
    assert "--models has none of 'drinkFromMug'" in capsys.readouterr().err
