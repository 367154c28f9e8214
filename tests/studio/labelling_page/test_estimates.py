"""A tracker's word of one frame, from a recording or from a model."""

from pathlib import Path

import numpy as np
import pytest
from inhand_lab.evaluation.fold_model import learn_fold_model
from inhand_lab.evaluation.folds import leave_one_out
from inhand_lab.labelling.keyframes import LabellingError
from inhand_studio.dataset_files import find_models
from inhand_studio.labelling_page.estimates import (
    has_estimates,
    model_of,
    recorded_estimate,
    tracked_estimate,
)
from inhand_studio.labelling_page.opened import OpenedRecording
from inhand_tracker.model.model_file import save_model
from waving import write_dataset


@pytest.mark.long
def test_a_model_of_the_dataset_says_where_the_object_is(tmp_path: Path) -> None:
    dataset = write_dataset(tmp_path, 3, frames=60)
    assert not find_models(tmp_path, [])
    with pytest.raises(LabellingError, match="there is no model of it"):
        model_of("box", [])
    (tmp_path / "models").mkdir()
    fold = leave_one_out(dataset)[0]
    learned = learn_fold_model(dataset, fold, images=False, fused=True)
    save_model(learned, tmp_path / "models" / "any name.model")
    model = model_of("box", find_models(tmp_path, []))
    with pytest.raises(LabellingError, match="no model of it"):
        model_of("mug", find_models(tmp_path, []))

    recording = OpenedRecording(dataset.path(dataset.entries[0]))
    assert not has_estimates(recording, "box")
    with pytest.raises(LabellingError, match="no estimates of box"):
        recorded_estimate(recording, "box", 50)
    shares: list[float] = []
    pose, confidence = tracked_estimate(
        recording.path, "camera", model, 50, shares.append, left_handed=False
    )
    truth = recording.label("box", 50)
    assert truth is not None
    assert np.linalg.norm(pose[0] - truth[0]) < 0.1
    assert 0.0 < confidence <= 1.0
    assert shares[-1] == 1.0
