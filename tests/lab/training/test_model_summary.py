"""A model's summary, on a mapping by hand."""

import numpy as np
import pytest
from inhand_lab.training.model_summary import summarise_model
from inhand_tracker.mapping.mapping import Mapping

FRAMES = 180


def test_what_was_learned_is_counted_over_all_frames() -> None:
    half, part = np.arange(FRAMES) < FRAMES // 2, np.full(FRAMES, 10)
    part[0] = 3
    summary = summarise_model(
        Mapping(
            participants=("a", "b", "a"),
            starts=np.array([0, 60, 120, FRAMES]),
            radii=np.array([0.1, 0.2, 0.4]),
            body_poses=np.zeros((FRAMES, 60)),
            translations=np.zeros((FRAMES, 19, 3)),
            rotations=np.zeros((FRAMES, 19, 4)),
            translation_variation=np.zeros(FRAMES),
            rotation_variation=np.where(half, 0.0, 10.0),
            stable_translation_part=part,
            stable_rotation_part=part,
            proximate_part=part,
        )
    )
    assert (summary.recordings, summary.participants, summary.frames) == (3, 2, FRAMES)
    assert summary.good_rotations == pytest.approx(0.5)
    assert summary.good_translations == 1.0
    assert summary.translation_part == ("HandRight", pytest.approx(1.0 - 1.0 / FRAMES))
    assert summary.radii == pytest.approx((0.1, 0.2, 0.4))
