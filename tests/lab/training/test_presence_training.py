"""What is learned of how objects are seen, from a small simulated world with images."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from inhand_lab.datasets.generation import GenerationSettings, generate
from inhand_lab.training.model_training import train
from inhand_lab.training.presence_training import (
    SupportSample,
    learn_presence,
    look_around,
    presence_of,
)
from inhand_tracker.model.model_file import save_model
from inhand_tracker.recognition.presence import Presence, usual_presence
from inhand_tracker.recognition.recogniser_file import load_recogniser
from inhand_tracker.sight.support import Support

from inhand.__main__ import main

ACTIONS = ("sweepFloor", "drinkFromMug")


def own_supports(presence: Presence) -> np.ndarray:
    """The mean supports (K,) of objects in images of themselves."""
    return np.diagonal(presence.supports)


@pytest.mark.long
@pytest.mark.timeout(900)
@pytest.mark.exhaustive
def test_objects_are_seen_better_where_they_are(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    people = generate(
        tmp_path / "set", GenerationSettings(ACTIONS, 2, 3, 90, images=True), lambda: None
    )
    models = [
        train(people, [e for e in people.entries if e.interaction == action]) for action in ACTIONS
    ]
    presence = learn_presence(people, people.entries, ACTIONS, models)
    assert (presence.supports + 10.0 < own_supports(presence)[:, None]).sum() == 2
    assert not np.allclose(presence.supports, usual_presence(2).supports)
    again = presence_of(look_around(people, people.entries, ACTIONS, models), ACTIONS)
    np.testing.assert_array_equal(own_supports(again), own_supports(presence))
    blind = replace(people, entries=())
    usual = learn_presence(blind, (), ACTIONS, models)
    np.testing.assert_allclose(own_supports(usual), own_supports(usual_presence(2)))

    files = [tmp_path / f"{action}.model" for action in ACTIONS]
    for model, file in zip(models, files, strict=True):
        save_model(model, file)
    learned = tmp_path / "actions.recogniser"
    command = ["train", str(people.folder), "-o", str(learned), "--recogniser", "--models"]
    assert main([*command, *map(str, files)]) == 0
    np.testing.assert_allclose(
        own_supports(load_recogniser(learned).presence), own_supports(presence)
    )
    capsys.readouterr()
    assert main([*command, str(files[0])]) == 2
    assert "--models has none of 'drinkFromMug'" in capsys.readouterr().err


def test_looks_of_one_action_fewer_teach_the_same_of_the_others() -> None:
    random = np.random.default_rng(4)
    actions = ("sweep", "drink", "call")
    samples = [
        SupportSample(
            done,
            {
                seen: Support(
                    *random.normal([1.0, 10.0 * (seen == done), 1.0, 9.0 * (seen == done)], 2.0)
                )
                for seen in actions
            },
        )
        for done in actions
        for _ in range(6)
    ]
    samples.append(SupportSample("drink", {}))
    of_all, of_two = presence_of(samples, actions), presence_of(samples, actions[:2])
    np.testing.assert_array_equal(own_supports(of_all)[:2], own_supports(of_two))
    kept = presence_of([sample for sample in samples if sample.action != "call"], actions[:2])
    np.testing.assert_array_equal(kept.supports, of_two.supports)
    np.testing.assert_array_equal(kept.spread, of_two.spread)
    np.testing.assert_array_equal(kept.parts, of_two.parts)
    np.testing.assert_array_equal(kept.part_spreads, of_two.part_spreads)


def test_the_object_that_resembles_another_is_learned_apart_from_those_that_do_not() -> None:
    actions = ("hammer", "brush", "call")
    resemblance = {("hammer", "brush"): 18.0, ("brush", "hammer"): 16.0}
    samples = [
        SupportSample(
            done,
            {
                seen: Support(
                    0.0, 25.0 * (seen == done) + resemblance.get((seen, done), 0.0), 0.0, 0.0
                )
            },
        )
        for done in actions
        for seen in actions
        for _ in range(20)
    ]
    supports = presence_of(samples, actions).supports
    expected = [[25.0, 18.0, 0.0], [16.0, 25.0, 0.0], [0.0, 0.0, 25.0]]
    np.testing.assert_allclose(supports, expected, atol=3.5)


def test_the_parts_of_an_objects_support_are_those_in_images_of_itself() -> None:
    samples = [
        SupportSample(
            "drink",
            {
                "drink": Support(4.0, 12.0 + off, 2.0, 9.0),
                "call": Support(0.0, 90.0 * off, 0.0, 0.0),
            },
        )
        for off in (-6.0, 6.0) * 200
    ]
    learned = presence_of(samples, ("drink", "call"))
    np.testing.assert_allclose(learned.parts, [[4.0, 12.0, 2.0, 9.0], [-np.inf] * 4])
    assert learned.part_spreads[0, 1] == pytest.approx(6.0, rel=0.05)
    np.testing.assert_allclose(learned.part_spreads[1], usual_presence(1).part_spreads[0])
