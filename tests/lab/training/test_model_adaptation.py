"""Adapting a model to a user's own recordings, which one is enough for."""

from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import mkdtemp

import numpy as np
import pytest
from inhand_lab.datasets.dataset import Dataset, DatasetError, load_dataset
from inhand_lab.training.model_adaptation import adapt, as_own, check_fits, taught_of
from inhand_lab.training.model_training import model_stages, recordings_of, train
from inhand_tracker.model.model import Model
from inhand_tracker.model.model_file import load_model, save_model
from inhand_tracker.prior.learning import learn_prior
from waving import write_dataset

from inhand.__main__ import main

FRAMES = 40


@cache
def dataset() -> Dataset:
    folder = Path(mkdtemp(prefix="inhand-test-")) / "people"
    write_dataset(folder, frames=FRAMES)
    return load_dataset(folder)


@cache
def taught() -> Model:
    """A model of all people but one."""
    return train(dataset(), recordings_of(dataset(), without=own()))


def own() -> tuple[str, ...]:
    """The name of the last one of these people."""
    return (dataset().entries[-1].participant,)


def own_recordings() -> list:
    others = {entry.participant for entry in dataset().entries} - set(own())
    return recordings_of(dataset(), without=sorted(others))


def test_one_recording_of_ones_own_adapts_a_model_that_keeps_what_it_was_taught(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    save_model(taught(), tmp_path / "before.model")
    others = sorted({entry.participant for entry in dataset().entries} - set(own()))
    left_out = [word for name in others for word in ("--without", name)]
    command = ["train", str(dataset().folder), "--from", str(tmp_path / "before.model")]
    assert main([*command, *left_out, "-o", str(tmp_path / "after.model")]) == 0
    before, after = (load_model(tmp_path / f"{name}.model") for name in ("before", "after"))
    assert after.taught is not None
    assert after.mapping.participants == (*before.mapping.participants, f"own {own()[0]}")
    assert [one.own for one in after.taught.sequences()] == [False] * len(after.taught.names)
    assert "saved" in capsys.readouterr().out


def test_what_is_learned_is_the_same_as_from_all_recordings_with_these_marked_as_own() -> None:
    adapted = adapt(taught(), dataset(), own_recordings())
    assert adapted.prior is not None
    assert adapted.taught is not None
    *others, mine = adapted.taught.sequences()
    expected = learn_prior([*others, replace(mine, own=True)], adapted.shape)
    np.testing.assert_allclose(adapted.prior.errors, expected.errors, atol=1e-4)


def test_steps_are_those_that_are_named() -> None:
    steps: dict[str, int] = {}

    def count(stage: str) -> None:
        steps[stage] = steps.get(stage, 0) + 1

    adapt(taught(), dataset(), own_recordings(), count)
    assert steps == model_stages(1, taught())


def test_somebody_of_the_same_name_is_another_person() -> None:
    sequence = taught_of(taught()).sequences()[0]
    assert as_own(sequence).participant != sequence.participant
    assert as_own(sequence).own


@pytest.mark.parametrize(
    ("changed", "why"),
    [
        ({"interaction": "sweep"}, "shows .*, and the model is of sweep"),
        ({"shape": "broom"}, "labels 'box', and the model is of 'broom'"),
        ({"shape": 1.02}, "the mesh of 'box' .* is not the one"),
    ],
)
def test_recordings_of_something_else_are_refused_in_one_line(changed: dict, why: str) -> None:
    model, shape = taught(), taught().shape
    if changed.get("shape") == "broom":
        model = replace(model, shape=replace(shape, name="broom"))
    elif "shape" in changed:
        model = replace(model, shape=replace(shape, vertices=1.02 * shape.vertices))
    else:
        model = replace(model, **changed)
    with pytest.raises(DatasetError, match=why):
        check_fits(model, dataset(), own_recordings())


def test_a_model_of_an_older_release_cannot_be_adapted_and_says_the_mend() -> None:
    with pytest.raises(DatasetError, match=r"keeps no recordings .* make it anew"):
        adapt(replace(taught(), taught=None), dataset(), own_recordings())


def test_where_everybody_is_left_out_nothing_is_adapted() -> None:
    with pytest.raises(DatasetError, match="no recording is left"):
        adapt(taught(), dataset(), [])


def test_a_recogniser_is_not_adapted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["train", str(dataset().folder), "--from", "a.model", "--recogniser"]
    assert main([*command, "-o", str(tmp_path / "b")]) == 2
    assert "leave --recogniser out" in capsys.readouterr().err
