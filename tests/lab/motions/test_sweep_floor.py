"""sweepFloor: strokes with both hands, the brush on the floor but on the way back."""

import numpy as np
import pytest
from inhand_lab.motions.performance import ContactKind
from performers import object_points, performed


@pytest.mark.parametrize("participant", range(10))
def test_sweeping_repeats_strokes_over_the_floor_with_both_hands(participant: int) -> None:
    _, performance, _ = performed("sweepFloor", participant)
    working = performance.contact == ContactKind.BOTH_HANDS
    points = object_points("sweepFloor", performance.world_from_object)
    brush = points[working][:, points[0, :, 2].argmin()]
    lowest = points[working][..., 2].min(axis=1)
    assert np.ptp(brush[:, 0]) > 0.3
    turns = np.count_nonzero(np.diff(np.sign(brush[:, 0] - np.median(brush[:, 0]))))
    assert turns >= 4
    assert np.mean(lowest < 0.01) > 0.3
    assert lowest.max() > 0.04
