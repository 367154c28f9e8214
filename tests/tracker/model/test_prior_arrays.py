"""A prior in its model's file."""

from dataclasses import fields, replace
from pathlib import Path

import numpy as np
from inhand_tracker.model.model_file import load_model, save_model
from inhand_tracker.model.prior_arrays import prior_from_arrays, prior_to_arrays
from inhand_tracker.prior.hold import Hold
from inhand_tracker.prior.prior import Prior
from people import unseen_wave, wave_model
from predictions import predictions


def assert_equal(one: Prior, other: Prior) -> None:
    for first, second in zip(one.regressions, other.regressions, strict=True):
        for field in fields(first):
            np.testing.assert_array_equal(getattr(first, field.name), getattr(second, field.name))
    for field in fields(Prior):
        if field.name not in ("regressions", "hold"):
            np.testing.assert_array_equal(getattr(one, field.name), getattr(other, field.name))
    assert one.hold is not None
    assert other.hold is not None
    for field in fields(Hold):
        np.testing.assert_array_equal(
            getattr(one.hold, field.name), getattr(other.hold, field.name)
        )


def test_a_prior_comes_back_from_its_arrays_as_it_was() -> None:
    prior = wave_model().prior
    assert prior is not None
    assert_equal(prior_from_arrays(prior_to_arrays(prior)), prior)


def test_a_prior_comes_back_from_its_model_s_file_as_it_was(tmp_path: Path) -> None:
    save_model(wave_model(), tmp_path / "wave.model")
    loaded = load_model(tmp_path / "wave.model").prior
    assert loaded is not None
    assert wave_model().prior is not None
    assert_equal(loaded, wave_model().prior)


def test_a_model_of_a_release_without_priors_still_loads(tmp_path: Path) -> None:
    save_model(replace(wave_model(), prior=None), tmp_path / "old.model")
    with np.load(tmp_path / "old.model") as archive:
        assert not [name for name in archive.files if name.startswith("prior")]
    assert load_model(tmp_path / "old.model").prior is None


def test_a_prior_of_a_release_without_holds_still_loads_and_predicts() -> None:
    prior = wave_model().prior
    assert prior is not None
    arrays = prior_to_arrays(prior)
    old = {name: array for name, array in arrays.items() if not name.startswith("hold.")}
    loaded = prior_from_arrays(old)
    assert loaded.hold is None
    assert np.isfinite(predictions(loaded, unseen_wave(3))[-1].covariance).all()
