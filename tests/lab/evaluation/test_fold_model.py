"""What is learned for a fold, with images and without."""

from pathlib import Path

import pytest
from inhand_lab.evaluation.fold_model import learn_fold_model
from inhand_lab.evaluation.folds import leave_one_out
from waving import write_dataset


def test_without_images_no_boundary_is_looked_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("inhand_lab.evaluation.fold_model.find_viewpoints", pytest.fail)
    dataset = write_dataset(tmp_path, frames=10)
    (fold, *_) = leave_one_out(dataset)
    for fused in (False, True):
        model = learn_fold_model(dataset, fold, images=False, fused=fused)
        assert model.interaction == "wave"
        assert (model.prior is not None) == fused
        assert model.appearance is None


def test_the_folds_of_an_interaction_share_the_objects_boundaries(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls: list[str] = []

    def found(shape: object) -> object:
        calls.append("found")
        return calls

    monkeypatch.setattr("inhand_lab.evaluation.fold_model.find_viewpoints", found)
    dataset = write_dataset(tmp_path, frames=10)
    models = [
        learn_fold_model(dataset, fold, images=True, fused=False) for fold in leave_one_out(dataset)
    ]
    assert len(models) == 3
    assert calls == ["found"]
