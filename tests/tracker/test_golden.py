"""What an older build recorded and learned still opens, and gives the poses that it gave then.

How the files were made is in ``golden/README.md``.
"""

from pathlib import Path

import numpy as np
import pytest
from inhand_lab.datasets.observations import observe
from inhand_lab.datasets.recorded_frames import load_frames
from inhand_tracker.methods.registry import new_tracker
from inhand_tracker.model.model_file import load_model

GOLDEN = Path(__file__).parent / "golden"
RECORDING = GOLDEN / "drinkFromMug.mcap"
MODEL = GOLDEN / "drinkFromMug.model"
SEED = 3


@pytest.mark.parametrize("method", ["fusion", "gd-stable-proximate"])
def test_an_old_recording_and_model_give_the_poses_they_gave(method: str) -> None:
    tracker = new_tracker(load_model(MODEL), method, left_handed=True, terms=(), seed=SEED)
    frames = load_frames(RECORDING, "mug")
    estimates = [seen.show(tracker) for seen in observe(RECORDING, frames)]
    with np.load(GOLDEN / "poses.npz") as poses:
        assert [estimate.state for estimate in estimates] == poses[f"{method}.states"].tolist()
        for field in ("translation", "rotation", "covariance"):
            estimated = [getattr(estimate, field) for estimate in estimates]
            expected = poses[f"{method}.{field}s"]
            if field == "rotation":  # a quaternion and its negative are one rotation
                agree = np.einsum("ti,ti->t", estimated, expected)
                expected = expected * np.sign(agree)[:, None]
            np.testing.assert_allclose(estimated, expected, rtol=0.0, atol=1e-7, err_msg=field)
        confidences = [estimate.confidence for estimate in estimates]
        np.testing.assert_allclose(confidences, poses[f"{method}.confidences"], atol=1e-9)
