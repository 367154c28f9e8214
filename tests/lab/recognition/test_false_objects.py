"""``inhand recognise --false-objects`` on small simulated worlds, without and with images."""

import json
import pickle
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from inhand_lab.datasets.generation import GenerationSettings, generate
from inhand_lab.datasets.recorded_frames import has_images
from inhand_lab.recognition import false_objects_by_movement
from inhand_lab.recognition.parameters import (
    DEFAULT_RECOGNITION_EVALUATION,
    RecognitionEvaluationParameters,
)
from inhand_lab.workers import in_processes

from inhand.__main__ import main

pytestmark = [pytest.mark.long, pytest.mark.timeout(900)]

ACTIONS = ("hammerNail", "putOnShoe", "drinkFromMug")


def use(monkeypatch: pytest.MonkeyPatch, parameters: RecognitionEvaluationParameters) -> None:
    monkeypatch.setattr("inhand.recognise.DEFAULT_RECOGNITION_EVALUATION", parameters)


def in_this_process(
    function: Callable[[Any], Any], tasks: list[Any], _: int, on_done: Callable[[Any], None]
) -> list[Any]:
    """What goes to other processes and back, but here, where what idle people do is shared."""
    function, tasks = pickle.loads(pickle.dumps((function, tasks)))
    return in_processes(function, tasks, 1, on_done)


def count(folder: Path, result: Path, *more: str) -> dict[str, dict[str, float]]:
    command = ["recognise", str(folder), "--false-objects", "--unseen", "p02"]
    assert main([*command, "--json", str(result), *more]) == 0
    counted: dict[str, dict[str, float]] = json.loads(result.read_text())
    for shares in (counted["nothing_in_use"], counted["others"], counted["never_trained"]):
        assert all(0.0 <= share <= 1.0 for share in shares.values())
    assert tuple(counted["never_trained"]) == ACTIONS
    return counted


def test_without_images_skeletons_alone_are_looked_at(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    use(monkeypatch, replace(DEFAULT_RECOGNITION_EVALUATION, idle_people_by_movement=1))
    monkeypatch.setattr(false_objects_by_movement, "in_processes", in_this_process)
    people = generate(
        tmp_path / "set", GenerationSettings(ACTIONS, 3, 5, 90, images=False), lambda: None
    )
    assert not has_images(people)
    counted = count(people.folder, tmp_path / "result.json")
    assert counted["images"] is False
    assert set(counted["nothing_in_use"]) == {"stand", "walkOnSpot", "walkAbout", "gesture"}
    assert counted["nothing_in_use"]["stand"] == 0.0
    shown = capsys.readouterr().out
    assert "skeletons alone" in shown
    assert "with images" not in shown


@pytest.mark.exhaustive
def test_with_images_the_cascade_sees_idle_people_strangers_and_untaught_actions(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    use(monkeypatch, replace(DEFAULT_RECOGNITION_EVALUATION, idle_kinds=("stand",)))
    people = generate(
        tmp_path / "set", GenerationSettings(ACTIONS, 3, 5, 90, images=True), lambda: None
    )
    strangers = generate(
        tmp_path / "others",
        GenerationSettings(("sweepFloor",), 1, 6, 30, images=False),
        lambda: None,
    )
    assert has_images(people)
    counted = count(people.folder, tmp_path / "result.json", "--others", str(strangers.folder))
    assert counted["images"] is True
    assert counted["others_images"] is False
    assert counted["nothing_in_use"] == {"stand": 0.0}
    assert set(counted["others"]) == {"sweepFloor"}
    shown = capsys.readouterr().out
    assert "with images" in shown
    assert "skeletons alone" in shown
